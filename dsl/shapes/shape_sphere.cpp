// sphere: rows of planar trapezoids between circles of latitude, ID.0, ID.1 ... from the lowest row up;
// triangles at the poles.
#include "dsl/report/limits.h"
#include "dsl/shapes/rings.h"
#include "dsl/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

using enum ValueType;

constexpr KeyRow kRows[] = {
    {"radius", kNumber, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Radius of the sphere that its corners lie on."},
    {"center", kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "", "Middle of the sphere."},
    {"sides", kInteger, false, "24", 3, 1000, "out-of-range", "",
     "Polygons around; half as many rows from pole to pole."},
    {"inward", kBoolean, false, "false", 0, 0, "", "", "All sides face inward."},
    {"smooth", kBoolean, false, "true", 0, 0, "", "",
     "Sides that meet at 30 degrees or less are shown as one curved surface."},
};

constexpr KeyTable kKeys = {"sphere", kRows};

void build(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kKeys);
  if (!require_material(input) || !map.good) return;
  input.scene.objects.is_smooth[input.object_row] = value_of(map, "smooth").integer[0] != 0;
  const DVec3 center = vec3_of(value_of(map, "center"));
  const double radius = value_of(map, "radius").number[0];
  const int64_t sides = value_of(map, "sides").integer[0], rows = std::max<int64_t>(2, sides / 2);
  const bool inward = value_of(map, "inward").integer[0] != 0;
  std::vector<std::vector<DVec3>> rings;  // the poles are rings of one corner
  for (int64_t row = 0; row <= rows; ++row) {
    const double angle = std::numbers::pi * static_cast<double>(row) / static_cast<double>(rows);
    const DVec3 middle = center - DVec3(0, radius * std::cos(angle), 0);
    const bool pole = row == 0 || row == rows;
    rings.push_back(pole
                        ? std::vector<DVec3>{middle}
                        : make_ring(middle, DVec3(0, 0, 1), DVec3(1, 0, 0), radius * std::sin(angle), sides));
  }
  input.scene.objects.is_solid[input.object_row] = !inward;
  size_t number = 0;
  for (size_t row = 0; row + 1 < rings.size(); ++row)
    for (size_t k = 0; k < static_cast<size_t>(sides); ++k) {
      const std::vector<DVec3>&low = rings[row], &high = rings[row + 1];
      const size_t next = (k + 1) % static_cast<size_t>(sides);
      std::vector<DVec3> corners;
      if (low.size() == 1)
        corners = {low[0], high[next], high[k]};
      else if (high.size() == 1)
        corners = {low[k], low[next], high[0]};
      else
        corners = {low[k], low[next], high[next], high[k]};
      if (inward) std::reverse(corners.begin(), corners.end());
      add_part(input, fmt::format(".{}", number++), corners);
    }
}

}  // namespace

extern const ShapeRow kSphereShape = {
    .name = "sphere",
    .keys = &kKeys,
    .build = build,
    .description = "A sphere of flat sides, its corners on the sphere.",
};

}  // namespace patchlight
