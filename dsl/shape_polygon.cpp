// polygon: a list of corners, with `holes`, as it stands.
#include "shapes.h"

namespace patchlight {

void build_polygon(const ShapeInput& input) {
  const Context& context = input.context;
  std::vector<DVec3> corners;
  const bool has_material = require_material(input);
  if (!read_corners(context, input.node, "a polygon", corners) || !has_material) return;
  add_part(input, "", corners);
  const uint32_t holes = value_of(input.object, "holes").node;
  if (holes == kNone) return;
  for (uint32_t hole = context.tree.nodes[holes].first; hole != kNone; hole = context.tree.nodes[hole].next)
    if (!report_null(context, hole, "a list of corners") && read_corners(context, hole, "a hole", corners))
      add_hole(input.scene.outlines, hole, corners);
}

}  // namespace patchlight
