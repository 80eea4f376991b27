// Scalars to numbers, strictly: what YAML dialects read in different ways is refused.
#pragma once

#include "dsl/language/context.h"

#include <cstdint>
#include <string_view>

namespace patchlight {

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

// Reports null-value at an empty node and returns true, or returns false.
bool report_null(const Context& context, uint32_t node, std::string_view expected);

}  // namespace patchlight
