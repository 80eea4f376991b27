// The variables of a scene: their values, and what a name means at a place of it.
#pragma once

#include "dsl/language/context.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace patchlight {

// All variables of all files. Their values are worked out before anything else is read (let.h).
struct VariableTable {
  enum class State : uint8_t { kWaiting, kKnown, kFailed };  // failed: what is wrong was told
  std::vector<std::string> name;                             // with the prefix of its include
  std::vector<std::string> prefix;                           // of the file that it stands in
  std::vector<uint32_t> node;                                // its value in the tree
  std::vector<double> value;
  std::vector<std::string> definition;  // "-D w=8" where the command line gave the value, else empty
  std::vector<State> state;
  std::unordered_map<std::string, uint32_t> row_of;
  size_t size() const { return name.size(); }
};

// The row of a variable of the files whose names begin with `prefix`, else of one of the scene; kNone where
// there is none.
uint32_t find_row(const VariableTable& variables, const std::string& prefix, std::string_view name);

enum class Lookup : uint8_t { kFound, kUnknown, kFailed };  // failed: already reported

// A repeat's index, else a variable of the context's file, else one of the scene.
Lookup find_variable(const Context& context, std::string_view name, double& value);

std::string undefined_variable_text(const Context& context, std::string_view name);

}  // namespace patchlight
