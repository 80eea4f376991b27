// box: six sides that face outward, ID.floor to ID.back.
#include "dsl/report/limits.h"
#include "dsl/shapes/shape.h"
#include "dsl/shapes/sides.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

constexpr KeyRow kRows[] = {
    {"size", ValueType::kVec3, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Lengths along x, y, z."},
    {"at", ValueType::kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "", "The low corner."},
};

constexpr KeyTable kKeys = {"box", kRows};

void build(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kKeys);
  if (!require_material(input) || !map.good) return;
  input.scene.objects.is_solid[input.object_row] = 1;
  const DVec3 low = vec3_of(value_of(map, "at")), high = low + vec3_of(value_of(map, "size"));
  for (size_t side = 0; side < kSideNames.size(); ++side)
    add_part(input, fmt::format(".{}", kSideNames[side]), side_corners(side, low, high, false));
}

}  // namespace

extern const ShapeRow kBoxShape = {
    .name = "box",
    .keys = &kKeys,
    .build = build,
    .description = "A box whose six sides face outward.",
};

}  // namespace patchlight
