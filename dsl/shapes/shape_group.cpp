// group: a list of objects that share a transform and settings. With an id, its objects are ID.theirs.
#include "dsl/shapes/objects.h"
#include "dsl/shapes/shape.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

void build(const ShapeInput& input) {
  const Tree& tree = input.context.tree;
  IdTable ids;
  size_t number = 0;
  for (uint32_t child = tree.nodes[input.node].first; child != kNone; child = tree.nodes[child].next) {
    ++number;
    if (is_id_taken(input.context, child, "", ids)) continue;
    read_object(input.context, child, {input.id + ".", fmt::format("{}.object{}", input.id, number)},
                input.own, input.scene);
  }
}

}  // namespace

extern const ShapeRow kGroupShape = {
    .name = "group",
    .type = ValueType::kList,
    .build = build,
    .description = "A list of objects that share a transform and settings.",
};

}  // namespace patchlight
