// Command line -> Options.
#pragma once

#include "flag_values.h"
#include "options.h"

namespace patchlight {

// Reads the arguments after the program's name. Throws UserError (slug usage) for unknown verbs and flags,
// with what was probably meant, and for values out of range.
Options parse_command_line(const std::vector<std::string>& arguments);

}  // namespace patchlight
