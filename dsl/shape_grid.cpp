// grid: a quad cut into nx times ny polygons, ID.0, ID.1 ... row by row from its first corner.
#include "limits.h"
#include "shapes.h"

#include <fmt/format.h>

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
     "Towards the lit side, any length."},
    {"origin", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "A corner; then u and v are required."},
    {"u", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the second corner."},
    {"v", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the last corner; the lit side is u x v."},
    {"cells", kIntegers2, true, "", 1, kAnyInteger, "out-of-range", "",
     "Polygons along the width and the height."},
};

constexpr KeyRule kRules[] = {
    {kOneOf, "size|origin", "", "missing-key", "a grid needs its size: [width, height], or origin, u and v"},
    {kExcludes, "center|size|normal", "origin|u|v", "ambiguous-shape",
     "a grid has either center, size, normal or origin, u, v"},
    {kNeeds, "origin|u|v", "origin|u|v", "missing-key", "a grid by edges needs origin, u and v"},
};

}  // namespace

const KeyTable kGridKeys = {"grid", kRows, kRules};

void build_grid(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kGridKeys);
  std::array<DVec3, 4> quad;
  if (!require_material(input) || !map.good || !read_quad(input, map, quad)) return;
  const int64_t nx = value_of(map, "cells").integer[0], ny = value_of(map, "cells").integer[1];
  uint64_t count = 0;
  const Limits& limits = input.context.messages.limits;
  if (__builtin_mul_overflow(static_cast<uint64_t>(nx), static_cast<uint64_t>(ny), &count) ||
      __builtin_mul_overflow(count, input.context.copies, &count) || count > limits.polygons) {
    add_error(input.context.messages, place_of(input.context.tree, value_of(map, "cells").node),
              "too-many-polygons",
              fmt::format("a grid of {} x {} takes the scene above the limit of {}", nx, ny,
                          limit_text(limits, &Limits::polygons)));
    return;
  }
  // A point of the lattice is worked out in one way, so that neighbours share its bits.
  const auto point = [&](int64_t x, int64_t y) {
    const double u = static_cast<double>(x) / static_cast<double>(nx),
                 v = static_cast<double>(y) / static_cast<double>(ny);
    return glm::mix(glm::mix(quad[0], quad[1], u), glm::mix(quad[3], quad[2], u), v);
  };
  for (int64_t y = 0; y < ny; ++y)
    for (int64_t x = 0; x < nx; ++x) {
      const DVec3 corners[] = {point(x, y), point(x + 1, y), point(x + 1, y + 1), point(x, y + 1)};
      add_part(input, fmt::format(".{}", y * nx + x), corners);
    }
}

}  // namespace patchlight
