// grid: a quad cut into nx times ny polygons, ID.0, ID.1 ... row by row from its first corner.
#include "dsl/shapes/quad.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr KeyRow kCells = {"cells",
                           ValueType::kIntegers2,
                           true,
                           "",
                           1,
                           kAnyInteger,
                           "out-of-range",
                           "",
                           "Polygons along the width and the height."};

constexpr auto kRows = [] {
  std::array<KeyRow, std::size(kQuadRows) + 1> rows;
  std::copy(std::begin(kQuadRows), std::end(kQuadRows), rows.begin());
  rows.back() = kCells;
  return rows;
}();

constexpr KeyTable kKeys = {"grid", kRows, kQuadRules};

void build(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kKeys);
  std::array<DVec3, 4> quad;
  if (!require_material(input) || !map.good || !read_quad(input.context, map, quad)) return;
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

}  // namespace

extern const ShapeRow kGridShape = {
    .name = "grid",
    .keys = &kKeys,
    .build = build,
    .description = "A quad cut into separate polygons, ID.0, ID.1 ... row by row.",
};

}  // namespace patchlight
