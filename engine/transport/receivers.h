// Which patches share one row of rays.
#pragma once

#include "engine/mesh/patches.h"

namespace patchlight {

// A receiver for every patch.
ReceiverTable make_single_receivers(const PatchTable& patches, const Surfaces& surfaces);

// Receivers for patches that are much smaller than the light between surfaces asks for, as those of imported
// models are: neighbours that face the same way and have as much room in front of them share one. The inside
// of a cupboard and its outside, which face the same way too, do not. ray_count is raised by the probing
// rays.
ReceiverTable make_receivers(const PatchTable& patches, const Surfaces& surfaces, uint64_t seed,
                             uint64_t& ray_count);

// After patches were split: parts of a patch on its own have receivers of their own, parts of others share
// theirs with them. parent: a row a patch as they are now: the one before. row_before: a row a receiver of
// the result: the one before, or kNone where its row must be cast.
ReceiverTable split_receivers(const ReceiverTable& before, std::span<const uint32_t> parent,
                              const PatchTable& patches, const Surfaces& surfaces,
                              std::vector<uint32_t>& row_before);

}  // namespace patchlight
