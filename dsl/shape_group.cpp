// group: a list of objects that share a transform and settings. With an id, its objects are ID.theirs.
#include "shapes.h"

#include <fmt/format.h>

namespace patchlight {

void build_group(const ShapeInput& input) {
  const Tree& tree = input.context.tree;
  if (tree.nodes[input.node].kind != NodeKind::kList) {
    add_error(input.context.messages, place_of(tree, input.node), "expected-list",
              fmt::format("expected a list of objects, got {}", describe(tree, input.node)));
    return;
  }
  size_t number = 0;
  for (uint32_t child = tree.nodes[input.node].first; child != kNone; child = tree.nodes[child].next)
    read_object(input.context, child, {input.id + ".", fmt::format("{}.object{}", input.id, ++number)},
                input.own, input.scene);
}

}  // namespace patchlight
