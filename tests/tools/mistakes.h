// What a call, or words of the command line, are answered with.
#pragma once

#include "dsl/report/diagnostics.h"
#include "tools/cli/command_line.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace patchlight::testing {

// The slug of the UserError that the call throws, or an empty string.
template <class Call>
std::string find_slug(Call call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.diagnostics.front().slug;
  }
  return "";
}

// The options of words whose first one is a verb.
inline Options parse_options(const std::vector<std::string>& words) {
  const Command command = parse_command_line(words);
  REQUIRE(command.verb != nullptr);
  CHECK(command.verb->name == words.front());
  return command.options;
}

// The slug and message of the UserError that the words give, or an empty string.
inline std::string find_mistake(const std::vector<std::string>& words) {
  try {
    parse_command_line(words);
  } catch (const UserError& error) {
    return error.diagnostics.front().slug + ": " + error.diagnostics.front().message;
  }
  return "";
}

}  // namespace patchlight::testing
