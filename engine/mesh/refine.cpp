// Differences between neighbours to marks.
//
// After the classroom rule: check neighbouring patches; if their radiosities differ more than a threshold,
// subdivide both (Cohen, Greenberg, Immel, Brock 1986 split on gradients alike).
#include "engine/mesh/refine.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <atomic>

namespace patchlight {
namespace {

constexpr float kFloorOfMean = 0.01f;  // differences below this share of the mean are not seen
constexpr float kNoiseMargin = 3;      // standard errors that a difference must exceed

// By how much the pair exceeds what is allowed, W/m2; 0 or less: it does not.
float find_excess(const RefineInput& input, uint32_t a, uint32_t b, float threshold) {
  const Rgb va = input.elements.radiosity[a], vb = input.elements.radiosity[b];
  const float difference = largest(abs(va - vb)), larger = std::max(largest(va), largest(vb));
  const float noise = std::hypot(input.error[a], input.error[b]);
  const float allowed =
      std::max(threshold * larger, kFloorOfMean * input.mean_radiosity) + kNoiseMargin * noise;
  return difference > allowed ? difference : 0;
}

}  // namespace

std::vector<uint8_t> mark_differing(const RefineInput& input, const Surfaces& surfaces,
                                    const RefineLimits& limits) {
  const FaceFrameTable& frames = surfaces.frames;
  const PatchTable& elements = input.elements;
  // The largest difference that each element has a part in; in the end, times its area, and 0 where
  // none may be split.
  std::vector<float> excess(elements.size(), 0);
  for_rows(input.fresh.size(), 512, [&](size_t begin, size_t end) {
    // The same pair may be met from both sides: the maximum does not depend on the order.
    const auto raise = [&](uint32_t row, float value) {
      std::atomic_ref<float> slot(excess[row]);
      float before = slot.load(std::memory_order_relaxed);
      while (before < value && !slot.compare_exchange_weak(before, value, std::memory_order_relaxed)) {
      }
    };
    for (size_t k = begin; k < end; ++k) {
      const uint32_t row = input.fresh[k];
      if (elements.exposed[row] == 0) continue;
      for (uint32_t edge = 0; edge < edge_count(frames, elements.face[row]); ++edge)
        for (const uint32_t other : find_neighbours(elements, frames, surfaces.links, row, edge)) {
          if (other == kNone || elements.exposed[other] == 0) continue;
          if (const float value = find_excess(input, row, other, limits.threshold); value > 0)
            raise(row, value), raise(other, value);
        }
    }
  });
  for_rows(elements.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      if (excess[row] <= 0) continue;
      const float edge =
          longest_edge(cell_corners(frames, elements.face[row], elements.cell[row], elements.level[row]));
      const float least = limits.patch_size_min[row];
      const bool is_least = elements.level[row] >= kLevelMax - 1 || edge < least;
      excess[row] *= is_least ? 0 : elements.area[row] / std::max(least * least, 1e-30f);
    }
  });
  return mark_within_budget(excess, elements, frames, surfaces.smooth_links, limits.patch_count_max);
}

void find_split_reasons(std::span<SplitReason> reasons, std::span<const uint8_t> marks,
                        const RefineInput& input, const Surfaces& surfaces, float threshold) {
  const PatchTable& elements = input.elements;
  const FaceFrameTable& frames = surfaces.frames;
  for_rows(elements.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      if (!marks[k]) continue;
      const auto row = static_cast<uint32_t>(k);
      float excess_largest = 0;
      reasons[row] = SplitReason::kBalance;
      for (uint32_t edge = 0; edge < edge_count(frames, elements.face[row]); ++edge)
        for (const uint32_t other : find_neighbours(elements, frames, surfaces.links, row, edge)) {
          if (other == kNone || elements.exposed[row] == 0 || elements.exposed[other] == 0) continue;
          const float excess = find_excess(input, row, other, threshold);
          if (excess <= excess_largest) continue;
          excess_largest = excess;
          const Rgb all = elements.radiosity[row] - elements.radiosity[other];
          const Rgb reflected =
              surfaces.faces.reflectance[elements.face[row]] * (input.direct[row] - input.direct[other]);
          reasons[row] = largest(abs(reflected)) >= largest(abs(all - reflected)) ? SplitReason::kDirect
                                                                                  : SplitReason::kIndirect;
        }
    }
  });
}

}  // namespace patchlight
