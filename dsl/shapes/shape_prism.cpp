// prism: a polygon pushed along its normal: walls ID.0, ID.1 ... and, with caps, ID.bottom and ID.top.
#include "dsl/polygons/flatten.h"
#include "dsl/report/limits.h"
#include "dsl/shapes/shape.h"
#include "dsl/shapes/walls.h"

namespace patchlight {
namespace {

using enum ValueType;

constexpr KeyRow kRows[] = {
    {"base", kCorners, true, "", 0, 0, "", "",
     "List of corners [x, y, z], counter-clockwise seen from where the prism grows to."},
    {"height", kNumber, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "How far it grows along the base's normal."},
    {"caps", kBoolean, false, "true", 0, 0, "", "", "With bottom and top."},
    {"inward", kBoolean, false, "false", 0, 0, "", "", "All sides face inward."},
};

constexpr KeyTable kKeys = {"prism", kRows};

void build(const ShapeInput& input) {
  const Context& context = input.context;
  const MapValues map = read_map(context, input.node, kKeys);
  if (!require_material(input) || !map.good) return;
  const uint32_t node = value_of(map, "base").node;
  std::vector<DVec3> base;
  if (!read_corners(context, node, "a base", base)) return;
  // The base is checked by itself, where its corners have places of their own; what is left has no repeats.
  OutlineTable outline;
  add_polygon(outline, input.object_row, input.id + ": base", input.own.material, node, base);
  FlatPolygon flat;
  if (!flatten_polygon(context.messages, context.tree, outline, 0, flat)) return;
  const DVec3 shift = flat.normal * value_of(map, "height").number[0];
  std::vector<DVec3> top = flat.points;
  for (DVec3& corner : top) corner += shift;
  add_walls(input, flat.points, top, value_of(map, "caps").integer[0] != 0,
            value_of(map, "inward").integer[0] != 0);
}

}  // namespace

extern const ShapeRow kPrismShape = {
    .name = "prism",
    .keys = &kKeys,
    .build = build,
    .description = "A polygon pushed along its normal.",
};

}  // namespace patchlight
