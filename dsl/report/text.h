// Words and numbers of a scene as text.
#pragma once

#include <string>
#include <string_view>

namespace patchlight {

// A number for messages: whole ones in full, others as short as tells them from all others.
std::string number_text(double number);

// True for a decimal number that from_chars refuses because it is too near to 0; its value is 0.
bool is_tiny(std::string_view digits);

// True for what matches [A-Za-z_][A-Za-z0-9_.-]*.
bool is_name(std::string_view text);

}  // namespace patchlight
