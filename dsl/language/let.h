// The maps `let` and the command line's definitions to the values of variables.
#pragma once

#include "dsl/language/variables.h"

#include <string>
#include <vector>

namespace patchlight {

// Adds the map `let`. Errors: bad-name, duplicate-id (defined by an include too).
void read_let(const Context& context, uint32_t node, VariableTable& variables);

// Gives variables their values from the command line ("w=8"). Errors, without a place: usage,
// undefined-variable, non-finite.
void define_variables(Messages& messages, const std::vector<std::string>& definitions,
                      VariableTable& variables);

// Works out all variables, which may be in any order; context.variables is `variables`. Mistakes in those
// that nothing uses are told too. Errors: variable-cycle and those of read_number.
void work_out_variables(const Context& context, VariableTable& variables);

}  // namespace patchlight
