// Settings to sizes, counts and bytes, before anything is solved; tables to bytes.
#include "solution.h"

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

uint64_t forecast_bytes(const FaceTable& faces, const SolverSettings& settings, uint64_t starting_patches) {
  // Bytes a row, from tables.h; the largest moment is a split, when the rows of the patches or, later, the
  // elements exist twice, or the making of the shared corners.
  constexpr uint64_t kFaceBytes = 700, kElementBytes = 190, kPatchBytes = 200;
  const uint64_t elements = std::max(starting_patches, settings.patch_count_max);
  const uint64_t patches = count_transport_patches(faces, settings);
  const uint64_t row_bytes =
      settings.keep_rows ? 8 * uint64_t{make_row_grid(count_row_rays(settings)).ray_count()} : 0;
  const uint64_t rows = row_bytes * patches;
  return kFaceBytes * faces.size() + kPatchBytes * patches +
         std::max(2 * rows + kElementBytes * std::max(starting_patches, patches),
                  rows + kElementBytes * elements);
}

uint64_t count_bytes(const Solution& s) {
  const auto bytes = [](const auto&... column) {
    return ((column.capacity() * sizeof(column[0])) + ... + 0);
  };
  const auto patch_bytes = [&](const PatchTable& t) {
    return bytes(t.face, t.cell, t.level, t.area, t.exposed, t.radiosity, t.unshot, t.face_first);
  };
  const auto vertex_bytes = [&](const VertexTable& t) {
    return bytes(t.leaf_vertex, t.vertex_first, t.vertex_leaf, t.hanging_between, t.hanging_order, t.border);
  };
  const FaceFrameTable& f = s.frames;
  return bytes(f.origin, f.edge_u, f.edge_v, f.twist, f.dual_u, f.dual_v, f.triangle, f.affine, s.links.edge,
               s.links.corner, s.joints.edge, s.joints.corner, s.element_first, s.element_patch,
               s.aims.list_of, s.aims.list_first, s.aims.lamp, s.receivers.first, s.receivers.patch,
               s.receivers.area_until, s.receivers.centre, s.receivers.normal, s.receivers.receiver_of,
               s.views.seen, s.views.hidden, s.views.settled, s.hits.patch, s.hits.cell, s.hits.nothing,
               s.hits.back, s.hits.buried, s.direct, s.direct_error, s.irradiance, s.irradiance_added,
               s.coarse, s.coarse_error, s.fresh, s.reasons) +
         patch_bytes(s.patches) + patch_bytes(s.elements) + vertex_bytes(s.patch_vertices) +
         vertex_bytes(s.element_vertices);
}

}  // namespace patchlight
