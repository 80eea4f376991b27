// The six sides of boxes and rooms: their names and corners.
#pragma once

#include "engine/base/vector.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace patchlight {

constexpr std::array<std::string_view, 6> kSideNames = {"floor", "ceiling", "left", "right", "front", "back"};

// Corners of the sides, counter-clockwise from outside. Bits of a corner: 1 high x, 2 high y, 4 high z.
constexpr std::array<std::array<uint8_t, 4>, 6> kSideCorners = {{
    {0, 1, 5, 4},  // floor: low y
    {2, 6, 7, 3},  // ceiling: high y
    {0, 4, 6, 2},  // left: low x
    {1, 3, 7, 5},  // right: high x
    {4, 5, 7, 6},  // front: high z
    {0, 2, 3, 1},  // back: low z
}};

// The four corners of a side of the box from low to high; every corner of the box is the same bits for all
// its sides.
inline std::array<DVec3, 4> side_corners(size_t side, DVec3 low, DVec3 high, bool inward) {
  std::array<DVec3, 4> corners;
  for (size_t k = 0; k < 4; ++k) {
    const uint8_t bits = kSideCorners[side][inward ? 3 - k : k];
    corners[k] = DVec3(bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y, bits & 4 ? high.z : low.z);
  }
  return corners;
}

}  // namespace patchlight
