// The variables of a scene: `let`, what the command line defines, and the indices of repeats.
#pragma once

#include "number.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace patchlight {

// A variable is worked out when it is first asked for, so that `let` may be in any order.
struct VariableTable {
  enum class State : uint8_t { kWaiting, kBusy, kKnown, kFailed };
  std::vector<std::string> name;    // with the prefix of its include
  std::vector<std::string> prefix;  // of the file that it stands in
  std::vector<uint32_t> node;       // its value in the tree
  std::vector<double> value;
  std::vector<std::string> definition;  // "-D w=8" where the command line gave the value, else empty
  std::vector<State> state;
  std::unordered_map<std::string, uint32_t> row_of;
  size_t size() const { return name.size(); }
};

// Adds the map `let`. Errors: bad-name, duplicate-id (defined by an include too).
void read_let(const Context& context, uint32_t node, VariableTable& variables);

// Gives variables their values from the command line ("w=8"). Errors, without a place: usage,
// undefined-variable, non-finite.
void define_variables(const Context& context, const std::vector<std::string>& definitions);

// Works out all variables, so that mistakes in unused ones are told too.
void check_variables(const Context& context);

enum class Lookup : uint8_t { kFound, kUnknown, kFailed };  // failed: already reported

// A repeat's index, else a variable of the context's file, else one of the scene.
Lookup find_variable(const Context& context, std::string_view name, double& value);

std::string undefined_variable_text(const Context& context, std::string_view name);

}  // namespace patchlight
