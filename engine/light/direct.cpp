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
// The same of a group of the sky's cells beside the sky alone: in the shade the sun says nothing of what
// counts.
constexpr double kWeakSky = 0.1;

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
  const PatchTable& elements = scene.mesh.elements;
  const EmitterGroups& groups = scene.groups;
  const SightTable& sights = scene.sights;
  const FaceFrameTable& frames = scene.surfaces.frames;
  assert(out.irradiance.size() == elements.size());
  const auto count_packets = [](uint32_t ray_count) {
    return std::clamp((ray_count + kPacketSize / 2) / kPacketSize, 1u, kPacketsMax);
  };
  const uint32_t packet_count = count_packets(rays.mixed);
  const uint32_t sky_packet_count = count_packets(rays.mixed_sky);
  const uint32_t most_packets =
      groups.sky_group_count > 0 ? std::max(packet_count, sky_packet_count) : packet_count;
  std::atomic<uint64_t> ray_count{0};
  for_rows(rows.size(), 64, [&](size_t begin, size_t end) {
    ElementPoints from(scene.surfaces, elements, most_packets);
    std::vector<GroupLook> looks;
    uint64_t cast = 0;
    for (size_t r = begin; r < end; ++r) {
      const uint32_t row = rows[r], receiver = scene.receivers.receiver_of[scene.mesh.element_patch[row]];
      Rgb irradiance(0);
      double variance = 0;  // emissions may be as large as 1e20
      start_element(from, row, seed);
      const uint32_t first = sights.first[receiver], last = sights.first[receiver + 1];
      out.irradiance[row] = Rgb(0);
      out.error[row] = out.noise[row] = 0;
      if (elements.exposed[row] == 0 || first == last) continue;
      make_packets(from, 1);
      if (from.open[0] == 0) continue;
      const auto corners = cell_corners(frames, elements.face[row], elements.cell[row], elements.level[row]);
      // What each group would give if nothing were in its way, and all of them together.
      looks.resize(last - first);
      double unoccluded = 0, sky = 0;
      for (uint32_t k = first; k < last; ++k) {
        GroupLook& look = looks[k - first];
        find_unoccluded(look, from, corners, groups, sights.group[k], sights.pieces[k]);
        unoccluded += look.strength;
        if (groups.is_sky_cells(sights.group[k])) sky += look.strength;
      }
      for (uint32_t k = first; k < last; ++k) {
        const GroupLook& look = looks[k - first];
        if (look.strength <= 0) continue;
        if (sights.clear[k]) {
          irradiance += look.irradiance;
          continue;
        }
        // One packet for a group that is weak among many.
        const bool of_sky = groups.is_sky_cells(sights.group[k]);
        const bool weak = look.strength < (of_sky ? kWeakSky * sky : kWeakLamp * unoccluded);
        const uint32_t most = weak ? 1 : of_sky ? sky_packet_count : packet_count;
        const VisibilitySums sums = find_visibility(from, look, groups, sights.group[k], most, rays.unmixed);
        cast += sums.rays;
        irradiance += sums.share() * look.irradiance;
        out.noise[row] += sums.noise() * mean_channel(look.irradiance);
        // Stratification makes N pairs worth about 3 N random ones (measured on half screens). Where all N
        // agree, one more might not have.
        const double visible = (sums.reached + 0.5) / (sums.rays + 1.0);
        variance +=
            double{look.strength} * look.strength * visible * (1 - visible) / (3.0 * std::max(sums.rays, 1u));
      }
      out.irradiance[row] = irradiance;
      out.error[row] = static_cast<float>(std::sqrt(variance));
    }
    ray_count += cast;
  });
  return ray_count;
}

}  // namespace patchlight
