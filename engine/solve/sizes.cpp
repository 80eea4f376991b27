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

uint64_t count_leaves_at_start(const FaceTable& faces, const FaceFrameTable& frames,
                               const PatchSizes& sizes) {
  uint64_t count = 0;
  for (uint32_t f = 0; f < faces.size(); ++f)
    count += uint64_t{1} << 2 * find_start_level(faces, frames, f, sizes);
  return count;
}

}  // namespace

AskedSizes find_asked_sizes(const FaceTable& faces, const SolverSettings& settings) {
  AskedSizes asked{faces.patch_size, faces.patch_size_min};
  for (size_t f = 0; f < faces.size(); ++f) {
    // What is asked of one face comes before what is asked of all.
    if (asked.start[f] <= 0 && settings.patch_size > 0)
      asked.start[f] = std::max(settings.patch_size, asked.least[f]);
    if (asked.least[f] <= 0) asked.least[f] = settings.patch_size_min;
  }
  return asked;
}

uint32_t find_start_level(const FaceTable& faces, const FaceFrameTable& frames, uint32_t face,
                          const PatchSizes& sizes) {
  const float asked = sizes.asked.start[face];
  const float wanted = asked > 0 ? asked : std::max(sizes.start, sizes.asked.least[face]);
  uint32_t level = faces.level_min[face];
  // A hair of slack: an edge of exactly twice the patch size is halved once.
  float edge = std::ldexp(longest_edge(cell_corners(frames, face, 0, 0)), -static_cast<int>(level));
  while (edge > wanted * 1.0001f && level < kLevelMax) edge /= 2, ++level;
  return std::min(level, kLevelMax - 1);
}

// How many patches may carry light between surfaces: one a face, and half of what that leaves of the budget,
// but no more than rooms need (8,000 to 30,000; a room of a million elements is no harder).
uint64_t count_transport_patches(const FaceTable& faces, const SolverSettings& settings) {
  // As sizes go, so goes the number of patches.
  const double factor = double{find_size_factor(settings)};
  const auto more = static_cast<uint64_t>(50000 / (factor * factor));
  const uint64_t face_count = faces.size(), budget = std::max<uint64_t>(settings.patch_count_max, face_count);
  return face_count + std::min((budget - face_count) / 2, more);
}

PatchSizes find_patch_sizes(const FaceTable& faces, const FaceFrameTable& frames,
                            const SolverSettings& settings) {
  PatchSizes sizes{settings.patch_size, settings.patch_size_min, find_asked_sizes(faces, settings)};
  if (sizes.start <= 0) {
    // An automatic size leaves half of what the faces themselves do not take of the budget to the rounds.
    const float scale = find_scene_scale(faces, frames);
    const uint64_t face_count = std::min<uint64_t>(faces.size(), settings.patch_count_max);
    const uint64_t most = face_count + (settings.patch_count_max - face_count) / 2;
    sizes.start = kPatchSize * find_size_factor(settings) * scale;
    while (sizes.start < scale && count_leaves_at_start(faces, frames, sizes) > most) sizes.start *= 1.25f;
  }
  if (sizes.least <= 0) sizes.least = kPatchSizeMin * find_size_factor(settings) * sizes.start;
  return sizes;
}

uint64_t count_starting_patches(const FaceTable& faces, const SolverSettings& settings) {
  const FaceFrameTable frames = make_face_frames(faces);
  return count_leaves_at_start(faces, frames, find_patch_sizes(faces, frames, settings));
}

}  // namespace patchlight
