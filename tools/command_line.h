// Command line -> Options.
#pragma once

#include "options.h"

namespace patchlight {

// Reads the arguments after the program's name. Throws UserError (slug usage) for unknown verbs and flags,
// with what was probably meant, and for values out of range.
Options parse_command_line(const std::vector<std::string>& arguments);

// One whole decimal number within [low, high]: digits only, no sign, no leading zero. `flag` names it in the
// message. Throws UserError (usage).
uint64_t parse_count(std::string_view flag, std::string_view text, uint64_t low, uint64_t high);
// One finite decimal number within [low, high]. Throws UserError (usage).
double parse_number(std::string_view flag, std::string_view text, double low, double high);
// "1,2,16": ascending, repeats dropped. Throws UserError (usage).
std::vector<uint32_t> parse_snapshots(std::string_view text);
// "960x720". Throws UserError (usage). Limits are checked with those of the scene's cameras.
std::array<uint32_t, 2> parse_size(std::string_view text);

}  // namespace patchlight
