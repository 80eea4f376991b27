// Command line -> a verb and its Options.
#pragma once

#include "tools/verbs/verbs.h"

#include <string>
#include <vector>

namespace patchlight {

struct Command {
  const Verb* verb = nullptr;  // none: only `text` is to be printed, help or versions
  Options options = {};
  std::string text = {};
};

// Reads the arguments after the program's name. Throws UserError (slug usage) for unknown verbs and flags,
// with what was probably meant, and for values out of range.
Command parse_command_line(const std::vector<std::string>& arguments);

// Do the words ask for messages as JSON? For those about words that cannot be parsed.
bool wants_json(const std::vector<std::string>& arguments);

}  // namespace patchlight
