// quad: a rectangle by centre, size and normal, or a parallelogram by origin, u and v.
#include "limits.h"
#include "shapes.h"

namespace patchlight {
namespace {

using enum ValueType;
using enum RuleKind;

constexpr KeyRow kRows[] = {
    {"size", kVec2, false, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Width and height. Required with center and normal."},
    {"center", kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Middle of the rectangle."},
    {"normal", kVec3, false, "0 1 0", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Towards the lit side, any length. The width lies along x where it can."},
    {"origin", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "A corner; then u and v are required."},
    {"u", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the second corner."},
    {"v", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the last corner; the lit side is u x v."},
};

constexpr KeyRule kRules[] = {
    {kOneOf, "size|origin", "", "missing-key", "a quad needs its size: [width, height], or origin, u and v"},
    {kExcludes, "center|size|normal", "origin|u|v", "ambiguous-shape",
     "a quad has either center, size, normal or origin, u, v"},
    {kNeeds, "origin|u|v", "origin|u|v", "missing-key", "a quad by edges needs origin, u and v"},
};

}  // namespace

const KeyTable kQuadKeys = {"quad", kRows, kRules};

bool read_quad(const ShapeInput& input, const MapValues& map, std::array<DVec3, 4>& corners) {
  if (has(map, "origin")) {
    const DVec3 origin = vec3_of(value_of(map, "origin")), u = vec3_of(value_of(map, "u")),
                v = vec3_of(value_of(map, "v"));
    corners = {origin, origin + u, origin + u + v, origin + v};
    return true;
  }
  DVec3 normal, width, height;
  if (!read_direction(input.context, value_of(map, "normal"), normal)) return false;
  make_axes(normal, width, height);
  const double* size = value_of(map, "size").number;
  const DVec3 half_w = width * (size[0] / 2), half_h = height * (size[1] / 2),
              center = vec3_of(value_of(map, "center"));
  corners = {center - half_w - half_h, center + half_w - half_h, center + half_w + half_h,
             center - half_w + half_h};
  return true;
}

void build_quad(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kQuadKeys);
  std::array<DVec3, 4> corners;
  if (require_material(input) && map.good && read_quad(input, map, corners)) add_part(input, "", corners);
}

}  // namespace patchlight
