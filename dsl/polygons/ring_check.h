// Do the rings of a flat polygon cross or touch?
#pragma once

#include "dsl/polygons/flat_polygon.h"

namespace patchlight {

enum class RingFault : uint8_t { kNoFault, kSelfIntersecting, kHoleOutside, kHoleTouches, kHolesOverlap };

struct RingCheck {
  RingFault fault = RingFault::kNoFault;
  uint32_t ring = 0;    // the ring to blame: of two, the later one
  uint32_t corner = 0;  // a corner of it at or near the fault
};

// Finds the first fault by a sweep over the edges: near-linear for polygons whose edges are short beside the
// whole. Distances below 1e-9 of the polygon's size count as contact.
RingCheck check_rings(const FlatPolygon& polygon);

// True when `point` is inside ring `ring` (even-odd rule).
bool is_inside_ring(const FlatPolygon& polygon, size_t ring, DVec2 point);

}  // namespace patchlight
