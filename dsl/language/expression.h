// Texts like =$w/2 to numbers.
#pragma once

#include "dsl/language/context.h"

#include <string_view>

namespace patchlight {

// True for what the language evaluates: $name, or a text that starts with '='.
bool is_expression(std::string_view text);

// The variable's name that a text begins with, behind its '$'.
std::string_view leading_name(std::string_view text);

// Evaluates the scalar at a node: + - * / ^ ( ) min max sin cos tan (degrees) sqrt abs floor pi and $names.
// False after an error: expression-syntax, expression-too-long, undefined-variable, variable-cycle,
// non-finite.
bool evaluate(const Context& context, uint32_t node, double& value);

}  // namespace patchlight
