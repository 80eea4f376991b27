// The faces of all polygons, in file units, before they become the engine's.
#pragma once

#include "dsl/polygons/triangulate.h"

#include <vector>

namespace patchlight {

// Sides of a face that have patches.
constexpr uint8_t kFrontSide = 1, kBackSide = 2;

struct CutTable {
  std::vector<DVec3> points;
  std::vector<uint32_t> point_first{0};  // polygons + 1
  std::vector<FaceCorners> faces;        // indices from the polygon's point_first
  std::vector<uint8_t> sides;            // a row a face: kFrontSide, kBackSide or both
  std::vector<uint32_t> sheet;  // a row a face: two that have the same are the sides of one sheet; or kNone
  std::vector<uint32_t> face_first{0};  // polygons + 1
  std::vector<DVec3> normal;            // a row a polygon: towards its front; 0: nothing was cut
  uint32_t sheet_count = 0;
  size_t size() const { return normal.size(); }
};

}  // namespace patchlight
