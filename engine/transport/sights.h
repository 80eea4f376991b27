// Which emitters each receiver sees: what its elements need not ask again.
#pragma once

#include "engine/light/emitters.h"
#include "engine/mesh/mesh.h"
#include "engine/transport/rows.h"

namespace patchlight {

// Polygons that aim at emitters: all of them, or none where emitters fill most of their sky, for then rows
// see them better. One answer for all polygons whose patches share receivers. A row a polygon.
std::vector<uint8_t> find_aiming(const Surfaces& surfaces, const EmitterGroups& groups,
                                 const PatchTable& patches, const ReceiverTable& receivers);

// Looks from all receivers at all groups; those that do not aim look at the sky alone. What a receiver's
// neighbours see it may see, too. Raises ray_count.
SightTable find_sights(const Casters& from, const EmitterGroups& groups, std::span<const uint8_t> aiming,
                       uint64_t& ray_count);

// After patches were split: receivers keep what those that they come from saw. receiver_before: a row a
// receiver.
SightTable inherit_sights(const SightTable& before, std::span<const uint32_t> receiver_before);

}  // namespace patchlight
