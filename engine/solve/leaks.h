// A solved scene to the light that leaves it, and where it leaves through a crack.
#pragma once

#include "engine/solve/solve.h"

namespace patchlight {

struct LeakReport {
  double escaped =
      0;  // share of the light of all surfaces, each as bright as the other, that leaves the scene
  double through_cracks = 0;  // the part of it that leaves so near to an edge that there is no window
  // The border edge that most of that passes: edge `edge` of a face runs from its corner `edge` to the next.
  uint32_t face = kNone, edge = 0;
};

// Rays from all patches, and of those that leave the scene the edge of a polygon's border that each passes
// nearest. An edge lies at a crack if most of the rays that pass it nearest pass it closely, compared with
// its length: rays through windows keep away from the edges around them. Looks for cracks only where some
// light leaves and most stays, as in a room that was to be closed; edges of a few thousand faces at most.
LeakReport find_leaks(const Solution& solution);

}  // namespace patchlight
