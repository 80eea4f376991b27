// Which lamps are aimed at, and by whom.
#pragma once

#include "tables.h"

#include <algorithm>

namespace patchlight {

// Which lamps each polygon aims at: up to kAimedLampsMax of those that could reach it, the strongest chosen;
// none where lamps fill most of its sky, for then rows see them better. One list for a whole polygon, and for
// all polygons whose patches share receivers, so that what patches leave to their rows is as smooth as the
// light itself.
AimTable make_aims(const FaceTable& faces, const FaceFrameTable& frames, const PatchTable& patches,
                   const ReceiverTable& receivers);

// True if polygon `polygon` aims at lamp `face`: then its rows must not count that lamp's emission again.
inline bool is_aimed(const AimTable& aims, uint32_t polygon, uint32_t face) {
  const uint32_t list = aims.list_of[polygon];
  const auto first = aims.lamp.begin() + aims.list_first[list],
             last = aims.lamp.begin() + aims.list_first[list + 1];
  return std::binary_search(first, last, face);
}

}  // namespace patchlight
