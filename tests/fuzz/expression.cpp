// Fuzz target: any bytes as an expression, with a few variables. It has a finite value, or an error in its
// text.
#include "dsl/expression.h"

#include "dsl/variables.h"
#include "engine/vector.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

using namespace patchlight;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

// A scalar of that text as the only node of a tree.
uint32_t add_scalar(Tree& tree, std::string_view text) {
  Node node;
  node.kind = NodeKind::kScalar;
  node.first = static_cast<uint32_t>(tree.text.size());
  node.count = static_cast<uint32_t>(text.size());
  node.line = node.column = 1;
  tree.text += text;
  tree.nodes.push_back(node);
  return static_cast<uint32_t>(tree.nodes.size() - 1);
}

void add_variable(Tree& tree, VariableTable& variables, const std::string& name, std::string_view text) {
  variables.row_of.emplace(name, static_cast<uint32_t>(variables.size()));
  variables.name.push_back(name);
  variables.prefix.emplace_back();
  variables.node.push_back(add_scalar(tree, text));
  variables.value.push_back(0);
  variables.definition.emplace_back();
  variables.state.push_back(VariableTable::State::kWaiting);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Messages messages;
  messages.files.push_back({"t.yaml", std::string(text)});
  Tree tree;
  tree.file_first.push_back(0);
  VariableTable variables;
  add_variable(tree, variables, "w", "8");
  add_variable(tree, variables, "h", "=$w/2");
  add_variable(tree, variables, "loop", "=$loop+1");
  add_variable(tree, variables, "own", text);  // what it says of itself
  const uint32_t node = add_scalar(tree, text);
  Context context{tree, messages, &variables};
  context.index[0] = 3.0;
  double number = 0;
  if (read_number(context, node, number)) {
    require(std::isfinite(number) && messages.errors.empty());
  } else {
    require(messages.errors.size() == 1 && !messages.errors[0].slug.empty());
  }
  int64_t whole = 0;
  read_integer(context, node, whole);
  return 0;
}
