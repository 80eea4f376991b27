// Which elements to split: the neighbour-threshold rule.
#pragma once

#include "engine/mesh/quadtree.h"
#include "engine/mesh/surfaces.h"

namespace patchlight {

struct RefineInput {
  const PatchTable& elements;       // radiosity: the coarse solution's
  std::span<const Rgb> direct;      // a row an element: irradiance that is a part of it once reflected, W/m2
  std::span<const float> error;     // a row an element: standard error of its radiosity, W/m2
  std::span<const uint32_t> fresh;  // elements not compared yet
  float mean_radiosity;             // W/m2, of reflected light
};

struct RefineLimits {
  float threshold;                        // share of the larger of two radiosities
  std::span<const float> patch_size_min;  // a row an element, lengths
  uint64_t patch_count_max;
};

// Marks both of two neighbours whose radiosities differ by more than `threshold` of the larger one (largest
// channel), by more than 1 % of the mean, and by more than their noise explains; not those whose longest edge
// is below patch_size_min. Where the budget does not suffice, the largest differences (times area, in squares
// of patch_size_min: small rooms in wide scenes count, too) go first.
// Neighbours are those within polygons: the two sides of a facet's edge differ, and no splitting changes
// that. Keeps the tree balanced across smooth links. Returns a row an element; all 0 if nothing is to be
// split.
std::vector<uint8_t> mark_differing(const RefineInput& input, const Surfaces& surfaces,
                                    const RefineLimits& limits);

// Why the marked elements are split: what their greatest difference beyond the threshold is made of, or
// balance where there is none. Rows that are not marked keep what they have.
void find_split_reasons(std::span<SplitReason> reasons, std::span<const uint8_t> marks,
                        const RefineInput& input, const Surfaces& surfaces, float threshold);

}  // namespace patchlight
