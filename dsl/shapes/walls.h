// Side walls and caps between two rings of corners: what cylinders and prisms are made of.
#pragma once

#include "dsl/shapes/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace patchlight {

// Adds walls ID.0, ID.1 ... between two rings of equally many corners, both counter-clockwise seen from the
// upper one's outside, and with `caps` the rings themselves as ID.bottom and ID.top. All face outward, or
// with `inward` all inward.
inline void add_walls(const ShapeInput& input, const std::vector<DVec3>& low, const std::vector<DVec3>& high,
                      bool caps, bool inward) {
  const auto add = [&](std::string_view part, std::vector<DVec3> corners) {
    if (inward) std::reverse(corners.begin(), corners.end());
    add_part(input, part, corners);
  };
  for (size_t k = 0; k < low.size(); ++k) {
    const size_t next = (k + 1) % low.size();
    add(fmt::format(".{}", k), {low[k], low[next], high[next], high[k]});
  }
  input.scene.objects.is_solid[input.object_row] = caps && !inward;
  if (!caps) return;
  add(".bottom", std::vector<DVec3>(low.rbegin(), low.rend()));
  add(".top", high);
}

}  // namespace patchlight
