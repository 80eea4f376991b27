// Which emitters each receiver sees: what its elements need not ask again.
#pragma once

#include "engine/light/emitters.h"
#include "engine/mesh/mesh.h"
#include "engine/transport/rows.h"

namespace patchlight {

// Looks from all receivers at all groups that they aim at, the sky's always. What a receiver's neighbours see
// it may see, too, and what its row has met, for looks may miss what shows through a gap. Raises ray_count.
SightTable find_sights(const Rows& rows, const EmitterGroups& groups, std::span<const float> emission_by_rows,
                       uint64_t& ray_count);

// After patches were split: receivers keep what those that they come from saw. receiver_before: a row a
// receiver.
SightTable inherit_sights(const SightTable& before, std::span<const uint32_t> receiver_before);

}  // namespace patchlight
