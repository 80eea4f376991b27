// Which patches share one row of rays.
#pragma once

#include "rows.h"

namespace patchlight {

// A receiver for every patch.
ReceiverTable make_single_receivers(const PatchTable& patches, const FaceTable& faces,
                                    const FaceFrameTable& frames);

// Receivers for patches that are much smaller than the light between surfaces asks for, as those of imported
// models are: neighbours that face the same way and have as much room in front of them share one. The inside
// of a cupboard and its outside, which face the same way too, do not. ray_count is raised by the probing
// rays.
ReceiverTable make_receivers(const PatchTable& patches, const FaceTable& faces, const FaceFrameTable& frames,
                             const Tracer& tracer, uint64_t seed, uint64_t& ray_count);

}  // namespace patchlight
