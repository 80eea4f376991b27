// The one door to nlohmann-json.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace patchlight {

using Json = nlohmann::ordered_json;

// Indented text with a newline at the end. Bytes that are not UTF-8 become U+FFFD instead of an exception.
inline std::string format_json(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace patchlight
