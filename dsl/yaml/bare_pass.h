// What reading a scene takes at least: the YAML parser's own work.
#pragma once

#include <cstdint>
#include <string>

namespace patchlight {

// Lets yaml-cpp go through a text and throws its events away; returns how many there were. Throws UserError
// (yaml-syntax) where the parser does not get through.
uint64_t count_yaml_events(const std::string& text);

}  // namespace patchlight
