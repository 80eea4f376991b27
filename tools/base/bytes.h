// Numbers -> the little-endian bytes that binary formats hold.
#pragma once

#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace patchlight {

static_assert(std::endian::native == std::endian::little,
              "the binary formats are written as memory holds them");

// Numbers, and structs of numbers of one size: GLM's vectors are not trivially copyable by their letter.
template <class Value>
constexpr bool kIsPlain = std::is_standard_layout_v<Value>&& std::is_trivially_destructible_v<Value>;

template <class Value>
void put_bytes(std::string& bytes, const Value& value) {
  static_assert(kIsPlain<Value>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Value>
std::string_view view_bytes(std::span<const Value> values) {
  static_assert(kIsPlain<Value>);
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace patchlight
