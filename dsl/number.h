// Scalars to numbers, strictly: what YAML dialects read in different ways is refused.
#pragma once

#include "messages.h"
#include "tree.h"

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
  VariableTable* variables = nullptr;  // nullptr: none
  std::string prefix = {};             // of names in this file: "lamps." for an include `as: lamps`
  std::array<std::optional<double>, 3> index = {};  // $i, $j, $k of the innermost repeats
  uint64_t copies = 1;                              // how often the enclosing repeats make what is read
};

// Reads a finite number, written out or as an expression. False after an error at the node: expected-number,
// non-finite, number-out-of-range, ambiguous-integer, null-value, and those of evaluate (expression.h).
bool read_number(const Context& context, uint32_t node, double& value);

// Reads a whole number; negative ones come out as out-of-range by the caller's limits, hence `value` is a
// double of it too. False after an error: expected-integer and those of read_number.
bool read_integer(const Context& context, uint32_t node, int64_t& value);

// Reads three numbers [x, y, z]. The error's slug for what is no list of three is `slug` (expected-vec3,
// expected-rgb).
bool read_three(const Context& context, uint32_t node, std::string_view slug, double (&value)[3]);

// Reads two numbers [a, b]; anything else is expected-list.
bool read_two(const Context& context, uint32_t node, double (&value)[3]);

// A number for messages: whole ones in full, others as short as tells them from all others.
std::string number_text(double number);

// True for a decimal number that from_chars refuses because it is too near to 0; its value is 0.
bool is_tiny(std::string_view digits);

// Reports null-value at an empty node and returns true, or returns false.
bool report_null(const Context& context, uint32_t node, std::string_view expected);

}  // namespace patchlight
