// Words and numbers of a scene as text.
#include "dsl/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace patchlight {

std::string number_text(double number) {
  if (std::abs(number) < 1e15 && number == std::floor(number)) return fmt::format("{:.0f}", number);
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, number).ptr);
}

bool is_tiny(std::string_view digits) {
  if (digits.starts_with('-')) digits.remove_prefix(1);
  const size_t e = std::min(digits.find_first_of("eE"), digits.size());
  const std::string_view mantissa = digits.substr(0, e);
  const size_t point = std::min(mantissa.find('.'), mantissa.size());
  const size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  int64_t exponent = 0;
  if (e < digits.size()) {
    const bool negative = digits.substr(e + 1).starts_with('-');
    const char* begin = digits.data() + e + 1 + (negative || digits.substr(e + 1).starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, digits.data() + digits.size(), exponent);
    if (error == std::errc::result_out_of_range) return negative;
    if (negative) exponent = -exponent;
  }
  return exponent < static_cast<int64_t>(first) - static_cast<int64_t>(point);
}

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (text.empty() || !letter(text[0])) return false;
  for (const char c : text)
    if (!letter(c) && !(c >= '0' && c <= '9') && c != '.' && c != '-') return false;
  return true;
}

}  // namespace patchlight
