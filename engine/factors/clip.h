// Polygons and their outlines cut at a plane: what a surface can see of another lies before its plane.
#pragma once

#include "engine/base/vector.h"

#include <span>
#include <vector>

namespace patchlight {

// The points p with dot(normal, p) >= height are kept.
struct HalfSpace {
  DVec3 normal;
  double height;
};

inline double height_above(const HalfSpace& space, DVec3 p) { return dot(space.normal, p) - space.height; }

// A directed piece of an outline: what it bounds lies to its left, seen from the lit side.
struct Segment {
  DVec3 start, end;
};

// Appends what is kept of a convex polygon to `kept`; at most one corner more than it has. Returns how many.
// (Sutherland, Hodgman: Reentrant Polygon Clipping, 1974.)
inline size_t clip_polygon(std::vector<DVec3>& kept, std::span<const DVec3> corners, const HalfSpace& space) {
  const size_t before = kept.size();
  for (size_t k = 0; k < corners.size(); ++k) {
    const DVec3 a = corners[k], b = corners[k + 1 == corners.size() ? 0 : k + 1];
    const double height_a = height_above(space, a), height_b = height_above(space, b);
    if (height_a >= 0) kept.push_back(a);
    if ((height_a >= 0) != (height_b >= 0)) kept.push_back(a + (height_a / (height_a - height_b)) * (b - a));
  }
  return kept.size() - before;
}

// Appends the outline of what is kept of an outline, which may have any number of rings, to `kept`. The
// pieces along the plane join the places where rings leave to those where they enter, in the order in which
// they are met: integrals along the whole outline do not depend on who is joined to whom.
void clip_outline(std::vector<Segment>& kept, std::span<const Segment> outline, const HalfSpace& space);

}  // namespace patchlight
