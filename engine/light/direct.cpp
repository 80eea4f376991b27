// Elements and lamps to direct irradiance.
#include "engine/light/direct.h"

#include "engine/base/parallel.h"
#include "engine/light/visibility.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>

namespace patchlight {
namespace {

// A lamp that gives less than this share of an element's light, blockers aside, gets no more than one packet.
constexpr double kWeakLamp = 0.06;

}  // namespace

uint64_t find_exposed(Mesh& mesh, std::span<const uint32_t> rows, const Surfaces& surfaces, uint64_t seed) {
  std::atomic<uint64_t> ray_count{0};
  for_rows(rows.size(), 256, [&](size_t begin, size_t end) {
    ElementPoints from(surfaces, mesh.elements, 1);
    for (size_t k = begin; k < end; ++k) {
      const uint32_t row = rows[k];
      const float share = mesh.patches.exposed[mesh.element_patch[row]];
      mesh.elements.exposed[row] = share;
      if (share == 0 || share == 1) continue;
      start_element(from, row, seed);
      make_packets(from, 1);
      const uint32_t buried = ~from.open[0] & 0xffff;
      mesh.elements.exposed[row] = 1 - static_cast<float>(std::popcount(buried)) / kPacketSize;
      ray_count += kPacketSize;
    }
  });
  return ray_count;
}

uint64_t find_direct(DirectColumns out, std::span<const uint32_t> rows, const DirectScene& scene,
                     DirectRays rays, uint64_t seed) {
  const PatchTable& elements = scene.elements;
  const LightListTable& lists = scene.lists;
  const FaceTable& faces = scene.surfaces.faces;
  const FaceFrameTable& frames = scene.surfaces.frames;
  assert(out.irradiance.size() == elements.size());
  const std::vector<Emitter> lamps = make_emitters(faces, frames);
  std::vector<uint32_t> lamp_of(faces.size(), kNone);
  for (uint32_t k = 0; k < lamps.size(); ++k) lamp_of[lamps[k].face] = k;
  const uint32_t packet_count = std::clamp((rays.mixed + kPacketSize / 2) / kPacketSize, 1u, kPacketsMax);
  std::atomic<uint64_t> ray_count{0};
  for_rows(rows.size(), 64, [&](size_t begin, size_t end) {
    ElementPoints from(scene.surfaces, scene.elements, packet_count);
    std::array<float, kAimedLampsMax> factor;
    uint64_t cast = 0;
    for (size_t r = begin; r < end; ++r) {
      const uint32_t row = rows[r], list = lists.list_of[faces.polygon[elements.face[row]]];
      const uint32_t first = lists.list_first[list], count = lists.list_first[list + 1] - first;
      const Vec3 normal = faces.normal[elements.face[row]];
      const uint64_t settled = out.views.settled[row], settled_seen = settled & out.views.seen[row];
      uint64_t seen = settled_seen, hidden = settled & out.views.hidden[row];
      Rgb irradiance(0);
      double variance = 0;  // emissions may be as large as 1e20
      start_element(from, row, seed);
      make_packets(from, 1);
      const bool dark = elements.exposed[row] == 0 || from.open[0] == 0;
      const auto corners = cell_corners(frames, elements.face[row], elements.cell[row], elements.level[row]);
      // What each lamp would give if nothing were in its way, and all of them together.
      double unoccluded = 0;
      for (uint32_t k = 0; k < count && !dark; ++k) {
        const Emitter& lamp = lamps[lamp_of[lists.lamp[first + k]]];
        factor[k] = 0;
        if (hidden >> k & 1u) continue;
        if (!can_reach(corners, normal, lamp))
          hidden |= uint64_t{1} << k;
        else
          factor[k] = find_mean_factor(from, corners, lamp, from.open[0]);
        unoccluded += factor[k] * luminance(faces.emission[lamp.face]);
      }
      for (uint32_t k = 0; k < count && !dark; ++k) {
        if (factor[k] == 0) continue;  // hidden, or the lamp's horizon crosses a part of the element
        const Emitter& lamp = lamps[lamp_of[lists.lamp[first + k]]];
        const Rgb emission = faces.emission[lamp.face];
        if (settled_seen >> k & 1u) {
          irradiance += factor[k] * emission;
          continue;
        }
        // One packet for a lamp that is weak among many.
        const double strength = factor[k] * luminance(emission);
        const uint32_t most = strength < kWeakLamp * unoccluded ? 1 : packet_count;
        const VisibilitySums sums = find_visibility(from, lamp, most, rays.unmixed);
        cast += sums.rays;
        const float visible = sums.share();
        if (sums.reached == sums.rays) seen |= uint64_t{1} << k;
        if (sums.reached == 0) hidden |= uint64_t{1} << k;
        irradiance += factor[k] * visible * emission;
        // Stratification makes N pairs worth about 3 N random ones (measured on half screens).
        variance += strength * strength * visible * (1 - visible) / (3.0 * std::max(sums.rays, 1u));
      }
      out.irradiance[row] = irradiance;
      out.error[row] = static_cast<float>(std::sqrt(variance));
      out.views.seen[row] = seen;
      out.views.hidden[row] = hidden;
    }
    ray_count += cast;
  });
  return ray_count;
}

uint64_t find_settled(const LampViewTable& views, const PatchTable& elements, const FaceFrameTable& frames,
                      const FaceLinkTable& links, uint32_t row) {
  uint64_t agreed = views.seen[row] | views.hidden[row];
  for (uint32_t edge = 0; edge < edge_count(frames, elements.face[row]); ++edge)
    for (const uint32_t other : find_neighbours(elements, frames, links, row, edge))
      if (other != kNone)
        agreed &= (views.seen[row] & views.seen[other]) | (views.hidden[row] & views.hidden[other]);
  return agreed;
}

}  // namespace patchlight
