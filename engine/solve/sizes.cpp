// Settings to sizes and counts, before anything is solved.
#include "engine/solve/sizes.h"

#include "engine/mesh/cell.h"

#include <algorithm>

namespace patchlight {
namespace {

// Of the square root of the scene's area, unless the user says otherwise.
constexpr float kPatchSize = 1 / 30.0f;
// Of the starting patch size.
constexpr float kPatchSizeMin = 1 / 64.0f;

uint64_t count_leaves_at_start(const FaceTable& faces, const FaceFrameTable& frames, float patch_size) {
  uint64_t count = 0;
  for (uint32_t f = 0; f < faces.size(); ++f)
    count += uint64_t{1} << 2 * find_start_level(faces, frames, f, patch_size);
  return count;
}

}  // namespace

uint32_t find_start_level(const FaceTable& faces, const FaceFrameTable& frames, uint32_t face,
                          float patch_size) {
  const float wanted = faces.patch_size[face] > 0 ? faces.patch_size[face] : patch_size;
  uint32_t level = faces.level_min[face];
  // A hair of slack: an edge of exactly twice the patch size is halved once.
  float edge = std::ldexp(longest_edge(cell_corners(frames, face, 0, 0)), -static_cast<int>(level));
  while (edge > wanted * 1.0001f && level < kLevelMax) edge /= 2, ++level;
  return std::min(level, kLevelMax - 1);
}

// How many patches may carry light between surfaces: one a face, and half of what that leaves of the budget,
// but no more than rooms need (4,000 to 15,000; a room of a million elements is no harder).
uint64_t count_transport_patches(const FaceTable& faces, const SolverSettings& settings) {
  // As sizes go, so goes the number of patches.
  const double factor = double{find_size_factor(settings)};
  const auto more = static_cast<uint64_t>(24000 / (factor * factor));
  const uint64_t face_count = faces.size(), budget = std::max<uint64_t>(settings.patch_count_max, face_count);
  return face_count + std::min((budget - face_count) / 2, more);
}

PatchSizes find_patch_sizes(const FaceTable& faces, const FaceFrameTable& frames,
                            const SolverSettings& settings) {
  float start = settings.patch_size;
  if (start <= 0) {
    // An automatic size leaves half of what the faces themselves do not take of the budget to the rounds.
    const float scale = find_scene_scale(faces, frames);
    const uint64_t face_count = std::min<uint64_t>(faces.size(), settings.patch_count_max);
    const uint64_t most = face_count + (settings.patch_count_max - face_count) / 2;
    start = kPatchSize * find_size_factor(settings) * scale;
    while (start < scale && count_leaves_at_start(faces, frames, start) > most) start *= 1.25f;
  }
  return {start, settings.patch_size_min > 0 ? settings.patch_size_min
                                             : kPatchSizeMin * find_size_factor(settings) * start};
}

uint64_t count_starting_patches(const FaceTable& faces, const SolverSettings& settings) {
  const FaceFrameTable frames = make_face_frames(faces);
  return count_leaves_at_start(faces, frames, find_patch_sizes(faces, frames, settings).start);
}

}  // namespace patchlight
