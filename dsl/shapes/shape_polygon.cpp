// polygon: a list of corners, with `holes`, as it stands.
#include "dsl/shapes/shape.h"

namespace patchlight {
namespace {

constexpr KeyRow kBeside[] = {
    {"holes", ValueType::kRings, false, "", 0, 0, "", "",
     "Beside polygon: lists of corners, each one a hole."},
};

// Is this a list of corners [x, y, z], where a list of such lists belongs?
bool is_one_ring(const Tree& tree, uint32_t list) {
  const uint32_t corner = tree.nodes[list].first;
  if (corner == kNone || tree.nodes[corner].kind != NodeKind::kList) return false;
  const uint32_t number = tree.nodes[corner].first;
  return number != kNone && tree.nodes[number].kind == NodeKind::kScalar;
}

void build(const ShapeInput& input) {
  const Context& context = input.context;
  std::vector<DVec3> corners;
  const bool has_material = require_material(input);
  if (!read_corners(context, input.node, "a polygon", corners) || !has_material) return;
  add_part(input, "", corners);
  const uint32_t holes = value_of(input.object, "holes").node;
  if (holes == kNone) return;
  const Tree& tree = context.tree;
  if (is_one_ring(tree, holes)) {
    add_error(context.messages, place_of(tree, holes), "expected-list",
              "'holes' is a list of holes, each a list of corners; put one more pair of brackets around");
    return;
  }
  for (uint32_t hole = tree.nodes[holes].first; hole != kNone; hole = tree.nodes[hole].next)
    if (!report_null(context, hole, "a list of corners") && read_corners(context, hole, "a hole", corners))
      add_hole(input.scene.outlines, hole, corners);
}

}  // namespace

extern const ShapeRow kPolygonShape = {
    .name = "polygon",
    .type = ValueType::kCorners,
    .beside = kBeside,
    .build = build,
    .description = "List of corners [x, y, z], counter-clockwise from the lit side.",
};

}  // namespace patchlight
