// The patches that carry light between surfaces: as fine as the space before them, and then as the light on
// them, asks for.
#pragma once

#include "engine/mesh/cell_rays.h"
#include "engine/mesh/quadtree.h"
#include "engine/mesh/surfaces.h"

namespace patchlight {

// Of the square root of the scene's area: a patch is never larger, and not split below the smallest.
constexpr float kPatchEdgeMax = 0.042f;
constexpr float kPatchEdgeMin = 0.0035f;
constexpr float kPatchEdgeMinAtSolid = 0.0021f;
// A patch's edge over the harmonic mean distance of what it sees (Ward, Heckbert: Irradiance Gradients, 1992,
// use the same mean for the reach of a sample).
constexpr float kPatchEdgePerDistance = 0.1f;

// What lies before a cell, told by a few rays of its own. Black fronts send nothing on and do not count as
// hits: lamps, and domes that are there for a sky.
struct Probe {
  uint32_t ray_count = 0, hit_count = 0, buried_count = 0;
  float inverse_distance_sum = 0;  // over the hits, 1 / lengths
};
Probe probe_cell(const CellRays& rays, const Surfaces& surfaces);

// What an author asks for: longest edges, a row a face, lengths; 0, or no rows: nothing.
struct AskedSizes {
  std::vector<float> start;  // of a starting patch
  std::vector<float> least;  // of a patch that may still be split
};

struct PatchSettings {
  uint64_t count_max;     // the budget
  float size_factor = 1;  // times all lengths that patches are sized by: below 1 splits further
  uint64_t seed = 1;
  float threshold = 0;    // least share by which neighbours that are split differ; 0: automatic
  AskedSizes asked = {};  // they start as coarse as it says, and end there
};

// Patches by geometry alone: split while larger than kPatchEdgePerDistance of the mean distance to what they
// see, and about solids; not below the starting size that is asked for. Returns leaves that are balanced
// across smooth links; ray_count is raised by the probing rays.
PatchTable make_patches(const Surfaces& surfaces, const PatchSettings& settings, uint64_t& ray_count);

// Surfaces::reach by patches, a row a patch, lengths: less on a part of a large face that lies before small
// things, such as the ground in a house. Raises ray_count.
std::vector<float> find_patch_reach(const PatchTable& patches, const Surfaces& surfaces, uint64_t seed,
                                    uint64_t& ray_count);

// A first solution on the patches, what they are split by once it is known. A row a patch, W/m2, largest
// channel.
struct PatchLight {
  std::span<const float> indirect;  // reflected of what other patches sent
  std::span<const float> total;     // and of the light that is aimed at
  std::span<const float> error;     // standard error of `indirect`
  std::span<const float> reach;     // not light, but lengths: find_patch_reach()
};

// Marks patches beside which indirect light changes by so much, over so much area, that it would show. What
// the noise of rows explains does not count. Where the budget does not suffice, the largest changes (times
// area) go first. Keeps the tree balanced across smooth links. Returns a row a patch; all 0 if nothing is to
// be split.
std::vector<uint8_t> mark_uneven(const PatchTable& patches, const PatchLight& light, const Surfaces& surfaces,
                                 const PatchSettings& settings);

}  // namespace patchlight
