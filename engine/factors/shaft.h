// Two surfaces and the faces of a scene to what may stand between the two.
#pragma once

#include "engine/factors/parts.h"

#include <array>

namespace patchlight {

// Boxes around faces, boxes around boxes: a node's first child follows it, its second is at `second`.
struct Bvh {
  std::vector<DVec3> low, high;  // lengths
  std::vector<uint32_t> second;  // kNone: a leaf
  std::vector<uint32_t> first;   // a leaf holds the entries [first, first + count) of face
  std::vector<uint32_t> count;
  std::vector<uint32_t> face;
};
// Of two faces back to back it holds one.
Bvh make_bvh(const FaceTable& faces, const PartTable& parts);

enum class Sight {
  kClear,   // nothing reaches between the two
  kHidden,  // one convex part stands between all of the one and all of the other
  kMixed    // something may: only rays tell
};

// One side of a pair: a convex polygon that holds all of it that the other may see.
struct ShaftEnd {
  uint32_t part;
  std::vector<DVec3> hull;
};

// What stands between two convex polygons: anything that reaches into the convex hull of both, other than
// the two parts themselves. Faces that touch the hull within rounding do not. kClear and kHidden are certain,
// kMixed is not: what is found may yet lie beside all lines of sight. (After Haines, Wallace: Shaft Culling
// for Efficient Ray-Cast Radiosity, 1991, with exact clipping.)
// The first few faces that reach in are written to `blockers`.
struct Blockers {
  std::array<uint32_t, 8> face;
  size_t count = 0;
};
Sight find_sight(Blockers& blockers, const Bvh& tree, const FaceTable& faces, const PartTable& parts,
                 const ShaftEnd& a, const ShaftEnd& b);

// Does a face stand between the two points, one in each of the two parts, which block nothing themselves? In
// double precision, and slow: for pairs so small, or so near each other, that rays of single precision would
// start beyond what is between.
bool is_blocked(const Bvh& tree, const FaceTable& faces, const PartTable& parts, uint32_t part_a,
                uint32_t part_b, DVec3 from, DVec3 to);

}  // namespace patchlight
