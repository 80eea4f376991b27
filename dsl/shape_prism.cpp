// prism: a polygon pushed along its normal: walls ID.0, ID.1 ... and, with caps, ID.bottom and ID.top.
#include "limits.h"
#include "shapes.h"
#include "walls.h"

namespace patchlight {
namespace {

using enum ValueType;

constexpr KeyRow kRows[] = {
    {"base", kList, true, "", 0, 0, "", "",
     "List of corners [x, y, z], counter-clockwise seen from where the prism grows to."},
    {"height", kNumber, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "How far it grows along the base's normal."},
    {"caps", kBoolean, false, "true", 0, 0, "", "", "With bottom and top."},
    {"inward", kBoolean, false, "false", 0, 0, "", "", "All sides face inward."},
};

}  // namespace

const KeyTable kPrismKeys = {"prism", kRows};

void build_prism(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kPrismKeys);
  std::vector<DVec3> base;
  if (!require_material(input) || !map.good ||
      !read_corners(input.context, value_of(map, "base").node, "a base", base))
    return;
  DVec3 normal(0), low(base[0]), high(base[0]);
  for (const DVec3& corner : base) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  const double size = glm::length(high - low);
  for (size_t k = 0; k < base.size() && size > 0; ++k)
    normal += glm::cross((base[k] - base[0]) / size, (base[(k + 1) % base.size()] - base[0]) / size);
  if (!(glm::length(normal) > 1e-10)) {
    add_error(input.context.messages, place_of(input.context.tree, value_of(map, "base").node), "zero-area",
              "the base has no area, so the prism has no direction");
    return;
  }
  const DVec3 shift = glm::normalize(normal) * value_of(map, "height").number[0];
  std::vector<DVec3> top = base;
  for (DVec3& corner : top) corner += shift;
  add_walls(input, base, top, value_of(map, "caps").integer[0] != 0, value_of(map, "inward").integer[0] != 0);
}

}  // namespace patchlight
