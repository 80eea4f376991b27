// The patches that carry light between surfaces: as fine as the space before them, and then as the light on
// them, asks for.
#pragma once

#include "rows.h"

namespace patchlight {

// Of the square root of the scene's area: a patch is never larger, and not split below the smallest.
constexpr float kPatchEdgeMax = 0.06f;
constexpr float kPatchEdgeMin = 0.005f;
constexpr float kPatchEdgeMinAtSolid = 0.003f;
// A patch's edge over the harmonic mean distance of what it sees (Ward, Heckbert: Irradiance Gradients, 1992,
// use the same mean for the reach of a sample).
constexpr float kPatchEdgePerDistance = 0.14f;

// What lies before a patch, told by a few rays of its own.
struct Probe {
  uint32_t ray_count = 0, hit_count = 0, buried_count = 0;
  float inverse_distance_sum = 0;  // over the hits, 1 / lengths
};
Probe probe_patch(const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer, uint32_t face,
                  uint32_t cell, uint32_t level, uint64_t row_key, RowGrid grid);

// Patches by geometry alone: split while larger than kPatchEdgePerDistance of the mean distance to what they
// see, and about solids; all of these lengths times size_factor. Returns balanced leaves; ray_count is raised
// by the probing rays.
PatchTable make_patches(const FaceTable& faces, const FaceFrameTable& frames, const FaceLinkTable& links,
                        const Tracer& tracer, uint64_t patch_count_max, float size_factor, uint64_t seed,
                        uint64_t& ray_count);

// A first solution on the patches, what they are split by once it is known. A row a patch, W/m2, largest
// channel.
struct PatchLight {
  std::span<const float> indirect;  // reflected of what other patches sent
  std::span<const float> total;     // and of the light that is aimed at
  std::span<const float> error;     // standard error of `indirect`
};

// Marks patches beside which indirect light changes by so much, over so much area, that it would show. What
// the noise of rows explains does not count. Where the budget does not suffice, the largest changes (times
// area) go first. Keeps the tree balanced across `joints`. Returns a row a patch; all 0 if nothing is to be
// split. A size_factor below 1 splits further.
std::vector<uint8_t> mark_uneven(const PatchTable& patches, const PatchLight& light, const FaceTable& faces,
                                 const FaceFrameTable& frames, const FaceLinkTable& links,
                                 const FaceLinkTable& joints, uint64_t patch_count_max, float size_factor);

}  // namespace patchlight
