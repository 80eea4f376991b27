// What a value is read with.
#pragma once

#include "dsl/report/messages.h"
#include "dsl/yaml/tree.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace patchlight {

struct VariableTable;

// What the readers of values need: the tree, where to report, and what names mean at this point of it.
struct Context {
  const Tree& tree;
  Messages& messages;
  const VariableTable* variables = nullptr;  // nullptr: none
  std::string prefix = {};                   // of names in this file: "lamps." for an include `as: lamps`
  std::array<std::optional<double>, 3> index = {};  // $i, $j, $k of the innermost repeats
  uint64_t copies = 1;                              // how often the enclosing repeats make what is read
};

}  // namespace patchlight
