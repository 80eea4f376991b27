// The variables of a scene.
#include "dsl/language/variables.h"

#include "engine/base/vector.h"

#include <fmt/format.h>

#include <cassert>

namespace patchlight {

uint32_t find_row(const VariableTable& variables, const std::string& prefix, std::string_view name) {
  auto row = variables.row_of.find(prefix + std::string(name));
  if (row == variables.row_of.end()) row = variables.row_of.find(std::string(name));
  return row == variables.row_of.end() ? kNone : row->second;
}

Lookup find_variable(const Context& context, std::string_view name, double& value) {
  if (name.size() == 1 && name[0] >= 'i' && name[0] <= 'k') {
    if (const std::optional<double> index = context.index[static_cast<size_t>(name[0] - 'i')]) {
      value = *index;
      return Lookup::kFound;
    }
  }
  if (!context.variables) return Lookup::kUnknown;
  const VariableTable& variables = *context.variables;
  const uint32_t row = find_row(variables, context.prefix, name);
  if (row == kNone) return Lookup::kUnknown;
  assert(variables.state[row] != VariableTable::State::kWaiting);
  value = variables.value[row];
  return variables.state[row] == VariableTable::State::kKnown ? Lookup::kFound : Lookup::kFailed;
}

std::string undefined_variable_text(const Context& context, std::string_view name) {
  std::string message =
      fmt::format("'{0}' is not defined; define it under 'let:' or with -D {0}=...", escape_text(name));
  if (!context.variables || !wants_errors(context.messages)) return message;
  if (const std::string near = did_you_mean(name, context.variables->name); !near.empty())
    message = fmt::format("'{}' is not defined; did you mean '{}'?", escape_text(name), escape_text(near));
  return message;
}

}  // namespace patchlight
