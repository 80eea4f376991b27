// Polygons in one plane that overlap, to sheets with one surface on either side: neither two lit surfaces nor
// a lit one and a back are left in one place, where rounding would choose.
#pragma once

#include "dsl/polygons/outlines.h"
#include "dsl/report/messages.h"
#include "dsl/scene/cut_table.h"
#include "dsl/yaml/tree.h"

namespace patchlight {

// What lies no further off a plane lies in it, engine lengths: about a ray's offset.
constexpr double kOnePlane = 2e-6;

// Two polygons in one plane, up to a ray's offset, that have area in common.
struct Overlap {
  uint32_t small, large;  // rows of OutlineTable; of equals, but for rounding, the later one is the small one
  bool one_way;           // a side of the one and a side of the other face the same way
  bool same_corners;
};

// All overlaps that matter: of polygons that face the same way, and of those back to back; not where a solid
// stands on a floor, which it buries. Meshes, and scenes of more than kPolygonsSearched polygons
// (suspicious.h), are not searched. `length`: an engine length in file units.
std::vector<Overlap> find_overlaps(const ObjectTable& objects, const OutlineTable& outlines,
                                   const CutTable& table, double length);

// Cuts the polygons of overlaps at each other's outlines: faces back to back become two sides of one sheet;
// where several face one way the smallest polygon is there alone, of equals the last. The same for faces that
// have the same corners in meshes and wherever the others could not be cut.
void join_sheets(const ObjectTable& objects, const OutlineTable& outlines,
                 const std::vector<uint8_t>& emits,  // a row a polygon
                 const std::vector<Overlap>& overlaps, double length, CutTable& table);

// Warns (coincident) of polygons that face the same way and overlap; of polygons that have the very same
// corners as an earlier one, in any order; of all such faces of one mesh together.
void warn_of_coincident(Messages& messages, const Tree& tree, const ObjectTable& objects,
                        const OutlineTable& outlines, const CutTable& table,
                        const std::vector<Overlap>& overlaps);

}  // namespace patchlight
