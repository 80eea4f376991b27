// Faces to planar parts of polygons: what form factors between polygons are found from.
#pragma once

#include "engine/factors/clip.h"
#include "engine/tables.h"

namespace patchlight {

// Corners as the scene has them, before they were rounded to the floats of the table of faces: a plate and
// the gap beside it may be a millionth of a millionth of the scene.
struct FineCorners {
  std::vector<std::array<DVec3, 4>> corners;  // a row a face, lengths; empty: floats are all there is
  DVec3 shift{0};  // what the table of faces takes off them: to take it off loses digits
};

// A flat polygon is one part, however many faces it was cut into; of one that is not flat, be it by little,
// each face is a part: rays meet the faces, and points of another plane would lie behind them. Lists of
// variable length are CSR: the row of part p is [first[p], first[p + 1]).
struct PartTable {
  std::vector<uint32_t> polygon;
  std::vector<HalfSpace> front;  // what lies before its lit side
  std::vector<double> area;      // lengths squared
  std::vector<DVec3> centre;     // of a ball that holds it
  std::vector<double> radius;
  std::vector<double> off_plane;  // lengths: how far its corners lie off the plane of `front`
  std::vector<double> touch;      // lengths: surfaces no further from it than this touch it
  std::vector<double> rounding;   // lengths: what its fine corners may be off; floats are taken as they are
  std::vector<uint32_t> outline_first;
  std::vector<Segment> outline;  // all rings, holes too; without the seams between its faces
  std::vector<uint32_t> hull_first;
  std::vector<DVec3> hull;            // corners of a convex polygon that holds it, at most kHullCornersMax
  std::vector<uint8_t> convex;        // 1: the hull is the part itself
  std::vector<uint32_t> piece_first;  // convex pieces that cover it
  std::vector<uint32_t> piece_corner_first;  // a row a piece
  std::vector<DVec3> piece_corner;
  std::vector<uint32_t> part_of_face;              // a row a face
  std::vector<std::array<DVec3, 4>> face_corners;  // a row a face
  DVec3 shift{0};                       // lengths: all places here less this are those of the table of faces
  std::vector<uint32_t> polygon_first;  // polygons + 1: the parts of each
  size_t size() const { return polygon.size(); }
};
constexpr size_t kHullCornersMax = 8;

// `polygon_count` may count polygons that have no faces.
PartTable make_parts(const FaceTable& faces, size_t polygon_count, const FineCorners& fine = {});

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

}  // namespace patchlight
