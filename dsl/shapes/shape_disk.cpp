// disk: one polygon of equal sides, its corners on a circle.
#include "dsl/report/limits.h"
#include "dsl/shapes/rings.h"
#include "dsl/shapes/shape.h"

namespace patchlight {
namespace {

using enum ValueType;

constexpr KeyRow kRows[] = {
    {"radius", kNumber, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Radius of the circle that its corners lie on."},
    {"center", kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "", "Middle of the circle."},
    {"normal", kVec3, false, "0 1 0", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Towards the lit side, any length."},
    {"sides", kInteger, false, "24", 3, kSidesMax, "out-of-range", "", "Number of corners."},
};

constexpr KeyTable kKeys = {"disk", kRows};

void build(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kKeys);
  DVec3 normal, width, height;
  if (!require_material(input) || !map.good ||
      !read_direction(input.context, value_of(map, "normal"), normal))
    return;
  make_axes(normal, width, height);
  add_part(input, "",
           make_ring(vec3_of(value_of(map, "center")), width, height, value_of(map, "radius").number[0],
                     value_of(map, "sides").integer[0]));
}

}  // namespace

extern const ShapeRow kDiskShape = {
    .name = "disk",
    .keys = &kKeys,
    .build = build,
    .description = "A flat polygon of equal sides, its corners on a circle.",
};

}  // namespace patchlight
