// polygon: a list of corners, with `holes`, as it stands.
#include "limits.h"
#include "shapes.h"

#include <fmt/format.h>

#include <cmath>

namespace patchlight {
namespace {

// A list of corners to `corners`; false after an error.
bool read_ring(const Context& context, uint32_t node, std::string_view what, std::vector<DVec3>& corners) {
  const Tree& tree = context.tree;
  if (tree.nodes[node].kind != NodeKind::kList) {
    add_error(context.messages, place_of(tree, node), "expected-list",
              fmt::format("expected a list of corners for {}, got {}", what, describe(tree, node)));
    return false;
  }
  const uint32_t count = tree.nodes[node].count;
  if (count < 3) {
    add_error(context.messages, place_of(tree, node), "too-few-vertices",
              fmt::format("{} needs at least 3 corners, got {}", what, count));
    return false;
  }
  if (count > kCornersMax) {
    add_error(context.messages, place_of(tree, node), "too-many-polygons",
              fmt::format("{} has {} corners, more than the limit of {}", what, count, kCornersMax));
    return false;
  }
  bool good = true;
  corners.clear();
  for (uint32_t child = tree.nodes[node].first; child != kNone; child = tree.nodes[child].next) {
    double number[3] = {0, 0, 0};
    good = read_three(context, child, "expected-vec3", number) && good;
    corners.emplace_back(number[0], number[1], number[2]);
  }
  return good;
}

}  // namespace

void build_polygon(const ShapeInput& input) {
  const Context& context = input.context;
  std::vector<DVec3> corners;
  const bool has_material = require_material(input);
  if (!read_ring(context, input.node, "a polygon", corners) || !has_material) return;
  add_polygon(input.outlines, input.object_row, input.id, input.material, input.node, corners);
  const uint32_t holes = value_of(input.object, "holes").node;
  if (holes == kNone) return;
  for (uint32_t hole = context.tree.nodes[holes].first; hole != kNone; hole = context.tree.nodes[hole].next)
    if (!report_null(context, hole, "a list of corners") && read_ring(context, hole, "a hole", corners))
      add_hole(input.outlines, hole, corners);
}

}  // namespace patchlight
