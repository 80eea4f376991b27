// cylinder: upright walls ID.0, ID.1 ... and, with caps, ID.bottom and ID.top.
#include "dsl/report/limits.h"
#include "dsl/shapes/rings.h"
#include "dsl/shapes/shape.h"
#include "dsl/shapes/walls.h"

namespace patchlight {
namespace {

using enum ValueType;

constexpr KeyRow kRows[] = {
    {"radius", kNumber, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Radius of the circle that its corners lie on."},
    {"height", kNumber, true, "", kAboveZero, kCoordinateMax, "out-of-range", "", "Length along y."},
    {"at", kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "", "Middle of its bottom."},
    {"sides", kInteger, false, "24", 3, kSidesMax, "out-of-range", "", "Number of walls."},
    {"caps", kBoolean, false, "true", 0, 0, "", "", "With bottom and top."},
    {"inward", kBoolean, false, "false", 0, 0, "", "", "All sides face inward."},
    {"smooth", kBoolean, false, "true", 0, 0, "", "",
     "Sides that meet at 30 degrees or less are shown as one curved surface."},
};

constexpr KeyTable kKeys = {"cylinder", kRows};

void build(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kKeys);
  if (!require_material(input) || !map.good) return;
  input.scene.objects.is_smooth[input.object_row] = value_of(map, "smooth").integer[0] != 0;
  // z before x: counter-clockwise seen from above.
  const std::vector<DVec3> low =
      make_ring(vec3_of(value_of(map, "at")), DVec3(0, 0, 1), DVec3(1, 0, 0),
                value_of(map, "radius").number[0], value_of(map, "sides").integer[0]);
  std::vector<DVec3> high = low;
  for (DVec3& corner : high) corner.y += value_of(map, "height").number[0];
  add_walls(input, low, high, value_of(map, "caps").integer[0] != 0, value_of(map, "inward").integer[0] != 0);
}

}  // namespace

extern const ShapeRow kCylinderShape = {
    .name = "cylinder",
    .keys = &kKeys,
    .build = build,
    .description = "An upright cylinder of flat sides.",
};

}  // namespace patchlight
