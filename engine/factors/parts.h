// Faces to planar parts of polygons: what form factors between polygons are found from.
#pragma once

#include "engine/factors/clip.h"
#include "engine/tables.h"

namespace patchlight {

// A flat polygon is one part, however many faces it was cut into; of one that is not flat each face is a
// part. Lists of variable length are CSR: the row of part p is [first[p], first[p + 1]).
struct PartTable {
  std::vector<uint32_t> polygon;
  std::vector<HalfSpace> front;  // what lies before its lit side
  std::vector<double> area;      // lengths squared
  std::vector<DVec3> centre;     // of a ball that holds it
  std::vector<double> radius;
  std::vector<uint32_t> outline_first;
  std::vector<Segment> outline;  // all rings, holes too; without the seams between its faces
  std::vector<uint32_t> hull_first;
  std::vector<DVec3> hull;            // corners of a convex polygon that holds it, at most kHullCornersMax
  std::vector<uint8_t> convex;        // 1: the hull is the part itself
  std::vector<uint32_t> piece_first;  // convex pieces that cover it
  std::vector<uint32_t> piece_corner_first;  // a row a piece
  std::vector<DVec3> piece_corner;
  std::vector<uint32_t> part_of_face;   // a row a face
  std::vector<uint32_t> polygon_first;  // polygons + 1: the parts of each
  size_t size() const { return polygon.size(); }
};
constexpr size_t kHullCornersMax = 8;

// `polygon_count` may count polygons that have no faces.
PartTable make_parts(const FaceTable& faces, size_t polygon_count);

inline std::span<const Segment> part_outline(const PartTable& parts, uint32_t part) {
  return std::span(parts.outline)
      .subspan(parts.outline_first[part], parts.outline_first[part + 1] - parts.outline_first[part]);
}
inline std::span<const DVec3> part_hull(const PartTable& parts, uint32_t part) {
  return std::span(parts.hull)
      .subspan(parts.hull_first[part], parts.hull_first[part + 1] - parts.hull_first[part]);
}
inline std::span<const DVec3> piece_corners(const PartTable& parts, uint32_t piece) {
  return std::span(parts.piece_corner)
      .subspan(parts.piece_corner_first[piece],
               parts.piece_corner_first[piece + 1] - parts.piece_corner_first[piece]);
}

// A convex polygon with at most kHullCornersMax corners, in the plane of `normal`, that holds some points of
// it (at least three that differ): `points` themselves where they are the corners of such a polygon already.
void set_hull(std::vector<DVec3>& hull, std::span<const DVec3> points, bool convex, DVec3 normal);

// How far from a plane a point may be, in lengths, and still lie in it: a few units in the last place of
// float corners near it. Surfaces that are no further apart than this touch.
inline double touch_distance(DVec3 p) {
  return 1e-6 * std::max({0.25, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

}  // namespace patchlight
