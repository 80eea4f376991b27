// The verbs of the program: one row a verb, one file NAME.cpp a row.
#pragma once

#include "tools/base/options.h"
#include "tools/base/talk.h"
#include "tools/base/usage.h"

#include <span>
#include <string_view>

namespace patchlight {

struct Verb {
  std::string_view name;
  std::string_view summary;  // in the list of verbs
  // Its help and its flags, which write into the options: into those that verbs share, and into options.own.
  void (*describe)(Usage&, Options&);
  // Returns the exit code. Throws UserError.
  int (*run)(const Options&, Talk&);
};

// In the order of help.
std::span<const Verb> verbs();

}  // namespace patchlight
