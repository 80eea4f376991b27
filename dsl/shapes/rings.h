// Corners on circles, shared by the round shapes.
#pragma once

#include "engine/base/vector.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace patchlight {

constexpr double kSidesMax = 10'000;  // as many as a polygon may have corners

// `sides` corners on a circle, counter-clockwise from the direction `width`; width x height is the axis.
inline std::vector<DVec3> make_ring(DVec3 center, DVec3 width, DVec3 height, double radius, int64_t sides) {
  std::vector<DVec3> ring;
  for (int64_t k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sides);
    ring.push_back(center + (width * std::cos(angle) + height * std::sin(angle)) * radius);
  }
  return ring;
}

}  // namespace patchlight
