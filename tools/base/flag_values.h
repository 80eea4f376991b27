// Values of flags, from words to numbers and choices. All throw UserError (usage) for what they do not know,
// with the flag, what was found and what was expected.
#pragma once

#include "tools/base/options.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

[[noreturn]] void fail_usage(const std::string& message);

// "; did you mean 'x'?", or nothing where no known word is near.
std::string hint(const std::string& word, const std::vector<std::string>& known);

// The parts between commas.
std::vector<std::string> split_list(std::string_view text);

// One whole decimal number within [low, high]: digits only, no sign, no leading zero. `flag` names it in the
// message.
uint64_t parse_count(std::string_view flag, std::string_view text, uint64_t low, uint64_t high);
// The same for bytes, which may end in k, M, G or T: 1000, 1000 times that, and so on.
uint64_t parse_bytes(std::string_view flag, std::string_view text);
// One finite decimal number within [low, high].
double parse_number(std::string_view flag, std::string_view text, double low, double high);
// "1,2,16" or "1-40,100": ascending, repeats dropped.
std::vector<uint32_t> parse_steps(std::string_view flag, std::string_view text);
// "960x720". Limits are checked with those of the scene's cameras.
std::array<uint32_t, 2> parse_size(std::string_view text);
// The index of `text` in `choices`.
size_t parse_choice(std::string_view flag, const std::string& text, const std::vector<std::string>& choices);

}  // namespace patchlight
