// Polygons that lie in one plane and cover each other, to regions with one surface on either side.
#pragma once

#include "dsl/polygons/cut.h"

#include <span>

namespace patchlight {

// A polygon of a sheet. `flat` holds its rings; it may lie either way round.
struct SheetPart {
  FlatPolygon flat;
  bool two_sided = false;
  bool emits = false;
};

// A part of the plane, and whose surface is on either side of it: rows of the parts, kNone where nobody's is.
struct SheetRegion {
  uint32_t up = kNone, down = kNone;
  CutFaces cut;  // corners counter-clockwise from above, which is where parts[0] is lit
};

constexpr size_t kSheetEdgesMax = 4096;  // of all parts together: pairs of them are searched

// The plane as its parts cover it. Where several are lit on one side, the smallest is there alone, and of
// equals the last. Regions of one part share whole edges or nothing. `near`: corners nearer than this to each
// other or to an edge touch it, file units. False, with nothing written, where there are too many edges or
// rounding leaves no way to cut.
bool cut_sheet(std::span<const SheetPart> parts, double near, std::vector<SheetRegion>& regions);

}  // namespace patchlight
