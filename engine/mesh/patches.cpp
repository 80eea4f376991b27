// Faces to patches, by what lies before them and by the light that they carry.
#include "engine/mesh/patches.h"

#include "engine/base/parallel.h"
#include "engine/mesh/buried.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace patchlight {
namespace {

constexpr uint32_t kProbeRayCount = 32;
// A difference between neighbours, beyond its noise, splits them if it is more than this share of their
// radiosity ...
constexpr float kUnevenShare = 0.01f;
// ... and, times the area of the patch over its squared reach, more than this share of the mean radiosity: in
// a room alone, a share of all light that it sends.
constexpr float kUnevenPower = 2.5e-6f;
constexpr float kUnevenNoise = 3;         // standard errors
constexpr float kUnevenEdgeMin = 0.001f;  // of the square root of the scene's area: no smaller parts

// As large as what a cell sees is far away in the harmonic mean, which small things before it rule; what
// leaves the scene is infinitely far. Never more than the whole face has.
float find_reach_before(const Probe& probe, uint32_t face, const Surfaces& surfaces) {
  if (surfaces.reach[face] <= surfaces.reach_least || probe.inverse_distance_sum <= 0)
    return surfaces.reach[face];
  const float distance = static_cast<float>(probe.ray_count) / probe.inverse_distance_sum;
  return std::min(find_reach_step(surfaces, kReachPerDistance * distance), surfaces.reach[face]);
}

// A lamp that reflects nothing: what it receives shows nowhere.
bool is_black_lamp(const Surfaces& surfaces, uint32_t face) {
  return surfaces.black[face] && largest(surfaces.faces.emission[face]) > 0;
}

float find_size(const std::vector<float>& asked, uint32_t face) { return asked.empty() ? 0 : asked[face]; }

}  // namespace

Probe probe_cell(const CellRays& rays, const Surfaces& surfaces) {
  const FaceTable& faces = surfaces.faces;
  Probe probe;
  probe.ray_count = rays.grid.ray_count();
  HitPacket packet;
  for (uint32_t tile = 0; tile < rays.grid.packet_count(); ++tile) {
    make_ray_packet(packet, rays, surfaces.frames, tile);
    find_hits(surfaces.tracer, packet, 0xffff);
    const uint32_t back = find_backs(packet, faces, 0xffff);
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const uint32_t face = packet.face[k];
      if (face == kNone || (largest(faces.reflectance[face]) == 0 && !(back >> k & 1u))) continue;
      ++probe.hit_count;
      probe.inverse_distance_sum += 1 / std::max(packet.ray.far_distance[k], 1e-6f);
    }
    if (back)
      probe.buried_count +=
          static_cast<uint32_t>(std::popcount(find_buried(surfaces, rays.frame, packet.ray, back)));
  }
  return probe;
}

PatchTable make_patches(const Surfaces& surfaces, const PatchSettings& settings, uint64_t& ray_count) {
  const FaceTable& faces = surfaces.faces;
  const FaceFrameTable& frames = surfaces.frames;
  const FaceLinkTable& links = surfaces.smooth_links;
  const uint64_t patch_count_max = settings.count_max;
  const auto find_scale = [&](uint32_t face) { return surfaces.reach[face] * settings.size_factor; };
  const float scale_least = surfaces.reach_least * settings.size_factor;
  // A hair of slack, as elements have it: an edge of exactly twice the size is halved once.
  const auto find_asked = [&](uint32_t face) {
    const float start = find_size(settings.asked.start, face);
    return 1.0001f * (start > 0 ? start : find_size(settings.asked.least, face));
  };
  // Large faces start split, as finely as half of what the faces themselves do not take of the budget allows.
  float edge_max = kPatchEdgeMax;  // scales
  const auto start_level = [&](uint32_t face) {
    uint32_t level = 0;
    float edge = longest_edge(cell_corners(frames, face, 0, 0));
    const float wanted = std::max(edge_max * find_scale(face), find_asked(face));
    while (edge > wanted && level < kLevelMax - 1) edge /= 2, ++level;
    return level;
  };
  const auto count_at_start = [&] {
    uint64_t count = 0;
    for (uint32_t f = 0; f < faces.size(); ++f) count += uint64_t{1} << 2 * start_level(f);
    return count;
  };
  const uint64_t room_at_start = patch_count_max > faces.size() ? (patch_count_max - faces.size()) / 2 : 0;
  while (edge_max < 1 && count_at_start() > faces.size() + room_at_start) edge_max *= 1.25f;
  PatchTable patches = make_leaves(faces, frames, start_level);
  balance_leaves(patches, frames, links);
  const RayGrid grid = make_ray_grid(kProbeRayCount);
  std::vector<uint8_t> fresh(patches.size(), 1);
  for (;;) {
    // Of those near to what they see, for their size, or at a solid: their areas in squares of their reach.
    std::vector<float> weight(patches.size(), 0);
    std::atomic<uint64_t> probed{0};
    for_rows(patches.size(), 64, [&](size_t begin, size_t end) {
      for (size_t row = begin; row < end; ++row) {
        const auto [face, cell, level] = name_cell(patches, row);
        const float edge = longest_edge(cell_corners(frames, face, cell, level));
        if (!fresh[row] || level >= kLevelMax - 2 || is_black_lamp(surfaces, face)) continue;
        if (edge < 2 * kPatchEdgeMinAtSolid * std::min(find_scale(face), scale_least)) continue;
        if (edge <= find_asked(face)) continue;
        const Probe probe =
            probe_cell(make_cell_rays(faces, {face, cell, level}, kProbeRays, settings.seed, grid), surfaces);
        probed += probe.ray_count;
        const bool at_solid = probe.buried_count > 0 && probe.buried_count < probe.ray_count;
        const bool is_near =
            edge * probe.inverse_distance_sum >
            kPatchEdgePerDistance * settings.size_factor * static_cast<float>(probe.hit_count);
        const float scale = find_reach_before(probe, face, surfaces) * settings.size_factor;
        const float edge_min = (at_solid ? kPatchEdgeMinAtSolid : kPatchEdgeMin) * scale;
        if (probe.buried_count == probe.ray_count || !(is_near || at_solid) || edge < 2 * edge_min) continue;
        weight[row] = patches.area[row] / (scale * scale);
      }
    });
    ray_count += probed;
    if (std::all_of(weight.begin(), weight.end(), [](float w) { return w == 0; })) return patches;
    // Where the budget ends, the largest have the most to gain.
    const std::vector<uint8_t> marks = mark_within_budget(weight, patches, frames, links, patch_count_max);
    bool last = false;
    for (size_t row = 0; row < weight.size(); ++row) last |= weight[row] > 0 && !marks[row];
    std::vector<uint32_t> parent;
    const PatchTable before = std::move(patches);
    patches = split_leaves(before, frames, marks, parent);
    if (last) return patches;
    fresh.assign(patches.size(), 0);
    for (size_t row = 0; row < patches.size(); ++row) fresh[row] = marks[parent[row]];
  }
}

std::vector<float> find_patch_reach(const PatchTable& patches, const Surfaces& surfaces, uint64_t seed,
                                    uint64_t& ray_count) {
  std::vector<float> reach(patches.size());
  const RayGrid grid = make_ray_grid(kProbeRayCount);
  std::atomic<uint64_t> probed{0};
  for_rows(reach.size(), 64, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const auto [face, cell, level] = name_cell(patches, static_cast<uint32_t>(row));
      reach[row] = surfaces.reach[face];
      if (reach[row] <= surfaces.reach_least) continue;
      const Probe probe =
          probe_cell(make_cell_rays(surfaces.faces, {face, cell, level}, kProbeRays, seed, grid), surfaces);
      probed += probe.ray_count;
      reach[row] = find_reach_before(probe, face, surfaces);
    }
  });
  ray_count += probed;
  return reach;
}

std::vector<uint8_t> mark_uneven(const PatchTable& patches, const PatchLight& light, const Surfaces& surfaces,
                                 const PatchSettings& settings) {
  const FaceFrameTable& frames = surfaces.frames;
  const float size_factor = settings.size_factor;
  const float area_factor = size_factor * size_factor;
  const float share = std::max(kUnevenShare * area_factor, settings.threshold);
  double power = 0, area = 0;
  for (size_t row = 0; row < patches.size(); ++row) {
    area += double{patches.area[row]};
    power += double{patches.area[row]} * light.total[row];
  }
  const auto power_least = static_cast<float>(kUnevenPower * power / area) * area_factor * area_factor;
  std::vector<float> weight(patches.size(), 0);
  for_rows(patches.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t at = begin; at < end; ++at) {
      const auto row = static_cast<uint32_t>(at);
      const uint32_t face = patches.face[row], level = patches.level[row];
      if (patches.exposed[row] == 0 || level >= kLevelMax - 2 || is_black_lamp(surfaces, face)) continue;
      const float size = longest_edge(cell_corners(frames, face, patches.cell[row], level));
      if (size < 2 * kUnevenEdgeMin * light.reach[row] * size_factor) continue;
      if (size < find_size(settings.asked.least, face)) continue;
      for (uint32_t edge = 0; edge < edge_count(frames, face); ++edge)
        for (const uint32_t other : find_neighbours(patches, frames, surfaces.links, row, edge)) {
          if (other == kNone || patches.exposed[other] == 0) continue;
          const float difference = std::abs(light.indirect[row] - light.indirect[other]) -
                                   kUnevenNoise * std::hypot(light.error[row], light.error[other]);
          if (difference > share * std::max(light.total[row], light.total[other]))
            weight[row] =
                std::max(weight[row], difference * patches.area[row] / (light.reach[row] * light.reach[row]));
        }
    }
  });
  for (float& change : weight)
    if (change <= power_least) change = 0;
  return mark_within_budget(weight, patches, frames, surfaces.smooth_links, settings.count_max);
}

}  // namespace patchlight
