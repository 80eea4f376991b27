// Settings to the sizes of patches and their numbers.
#pragma once

#include "engine/mesh/patches.h"
#include "engine/settings.h"
#include "engine/tables.h"

namespace patchlight {

// What the author asks for, of each face or of all.
AskedSizes find_asked_sizes(const FaceTable& faces, const SolverSettings& settings);

// How the settings size the mesh, in lengths: the longest edge of a starting patch, and of one that may still
// be split.
struct PatchSizes {
  float start, least;
  AskedSizes asked;  // before these
};
PatchSizes find_patch_sizes(const FaceTable& faces, const FaceFrameTable& frames,
                            const SolverSettings& settings);
// How often a face is halved before the first round.
uint32_t find_start_level(const FaceTable& faces, const FaceFrameTable& frames, uint32_t face,
                          const PatchSizes& sizes);
// How many patches may carry light between surfaces.
uint64_t count_transport_patches(const FaceTable& faces, const SolverSettings& settings);
// Elements that the settings ask for before any split; may exceed 2^32. For limits, before any memory is
// taken.
uint64_t count_starting_patches(const FaceTable& faces, const SolverSettings& settings);

}  // namespace patchlight
