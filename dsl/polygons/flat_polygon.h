// A polygon on its own plane: what the checks and the cutters work on.
#pragma once

#include "engine/base/vector.h"

#include <vector>

namespace patchlight {

// A polygon without repeated corners, on its own plane. Rings are the outline, counter-clockwise, then the
// holes, clockwise.
struct FlatPolygon {
  std::vector<DVec3> points;         // corners of all rings, file units, the very bits of the outline table
  std::vector<DVec2> flat;           // the same on the plane, in units of `size` from `origin`
  std::vector<uint32_t> ring_first;  // rings + 1
  DVec3 origin{0}, axis_u{0}, axis_v{0}, normal{0};  // normal = axis_u x axis_v, unit, towards the lit side
  double size = 0;                                   // diagonal of the corners' bounding box, file units
  double area = 0;                                   // holes taken off, in units of size squared
  DVec2 centroid{0};                                 // in units of size
  double off_plane = 0;         // largest distance of a corner from the plane, in units of size
  bool of_mesh = false;         // a face of a mesh: it is cut as little as possible
  bool only_triangles = false;  // its outline touches itself: no quads, no rings
  size_t ring_count() const { return ring_first.size() - 1; }
};

// off_plane up to which faces may be quads. A quad's points are bilinear and a ray meets its two triangles:
// further apart than a ray's offset, points of the one would lie behind the other and see its back.
constexpr double kQuadFlatMax = 2e-6;
constexpr double kFlatMax = 1e-4;       // off_plane up to which a polygon counts as flat
constexpr double kNonPlanarMax = 0.02;  // off_plane up to which it is cut into triangles

// Twice the signed area of the triangle a, b, c: above 0 when counter-clockwise.
inline double turn(DVec2 a, DVec2 b, DVec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace patchlight
