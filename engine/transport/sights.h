// Which emitters each receiver sees: what its elements need not ask again.
#pragma once

#include "engine/light/emitters.h"
#include "engine/mesh/mesh.h"
#include "engine/transport/rows.h"

namespace patchlight {

// Where emitters fill most of a polygon's sky its rows see them better than rays that aim at each. A row a
// polygon: its rows see what emits up to this (W/m2, luminance), and it aims at what is brighter, such as a
// sun before a dome; 0: it aims at all. One answer for all polygons whose patches share receivers.
std::vector<float> find_emission_by_rows(const Surfaces& surfaces, const EmitterGroups& groups,
                                         const PatchTable& patches, const ReceiverTable& receivers);

// Looks from all receivers at all groups that they aim at, the sky's always. What a receiver's neighbours see
// it may see, too. Raises ray_count.
// What a row has met counts as seen, for looks may miss what shows through a gap.
SightTable find_sights(const Rows& rows, const EmitterGroups& groups, std::span<const float> emission_by_rows,
                       uint64_t& ray_count);

// After patches were split: receivers keep what those that they come from saw. receiver_before: a row a
// receiver.
SightTable inherit_sights(const SightTable& before, std::span<const uint32_t> receiver_before);

}  // namespace patchlight
