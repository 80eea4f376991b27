// Which lamps are aimed at, and by whom.
#pragma once

#include "engine/mesh/surfaces.h"

#include <algorithm>

namespace patchlight {

// Which lamps each polygon aims at: up to kAimedLampsMax of those that could reach it, the strongest chosen;
// none where lamps fill most of its sky, for then rows see them better. One list for a whole polygon, and for
// all polygons whose patches share receivers, so that what patches leave to their rows is as smooth as the
// light itself.
LightListTable make_light_lists(const Surfaces& surfaces, const PatchTable& patches,
                                const ReceiverTable& receivers);

// True if polygon `polygon` aims at lamp `face`: then its rows must not count that lamp's emission again.
inline bool is_aimed(const LightListTable& lists, uint32_t polygon, uint32_t face) {
  const uint32_t list = lists.list_of[polygon];
  const auto first = lists.lamp.begin() + lists.list_first[list],
             last = lists.lamp.begin() + lists.list_first[list + 1];
  return std::binary_search(first, last, face);
}

}  // namespace patchlight
