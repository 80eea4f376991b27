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

// A group that gives less than this share of an element's light, blockers aside, gets one packet at first.
// Cells of the sky are compared with the sky alone: in the shade the sun says nothing of what counts.
constexpr double kWeakGroup = 0.1;
// Rays of all groups together beyond the first ones, in those that one group may have: two that are seen in
// part, as bright as one another, take all they may.
constexpr double kMixedGroups = 2;

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
  assert(out.irradiance.size() == elements.size());
  const auto count_packets = [](uint32_t ray_count) {
    return std::clamp((ray_count + kPacketSize / 2) / kPacketSize, 1u, kPacketsMax);
  };
  const uint32_t packet_count = count_packets(rays.mixed);
  const uint32_t first_packets = std::min(count_packets(rays.unmixed), packet_count);
  std::atomic<uint64_t> ray_count{0};
  for_rows(rows.size(), 64, [&](size_t begin, size_t end) {
    ElementPoints from(scene.surfaces, elements, packet_count);
    std::vector<GroupLook> looks;
    std::vector<VisibilitySums> sums;
    std::vector<double> doubts;  // standard errors of a ray, W/m2
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
      // What each group would give if nothing were in its way, and whether something is.
      looks.resize(last - first);
      sums.assign(last - first, {});
      doubts.assign(last - first, 0);
      double unoccluded = 0, sky = 0, all_doubts = 0;
      for (uint32_t k = 0; k < last - first; ++k) {
        find_unoccluded(looks[k], from, groups, sights.group[first + k], sights.pieces[first + k]);
        unoccluded += looks[k].strength;
        if (groups.is_sky_cells(sights.group[first + k])) sky += looks[k].strength;
      }
      for (uint32_t k = 0; k < last - first; ++k) {
        const uint32_t group = sights.group[first + k];
        if (looks[k].strength <= 0 || sights.clear[first + k]) continue;
        const double all = groups.is_sky_cells(group) ? sky : unoccluded;
        add_visibility(sums[k], from, looks[k], groups, group, 0,
                       looks[k].strength < kWeakGroup * all ? 1 : first_packets);
        if (!sums[k].mixed() && !rays.sure) continue;
        doubts[k] = looks[k].strength * std::sqrt(sums[k].variance());
        all_doubts += doubts[k];
      }
      for (uint32_t k = 0; k < last - first; ++k) {
        const GroupLook& look = looks[k];
        if (look.strength <= 0) continue;
        if (sights.clear[first + k]) {
          irradiance += look.irradiance;
          continue;
        }
        if (doubts[k] > 0) {
          // More rays where they take most variance away (Neyman's allocation).
          const double share = std::min(kMixedGroups * doubts[k] / all_doubts, 1.0);
          const auto more = static_cast<uint32_t>(std::lround(share * (packet_count - first_packets)));
          const uint32_t had = sums[k].packets;
          add_visibility(sums[k], from, look, groups, sights.group[first + k], had, had + more);
        }
        cast += sums[k].rays;
        irradiance += sums[k].share() * look.irradiance;
        out.noise[row] += sums[k].noise() * mean_channel(look.irradiance);
        // Stratification makes N pairs worth about 3 N random ones (measured on half screens).
        variance +=
            double{look.strength} * look.strength * sums[k].variance() / (3.0 * std::max(sums[k].rays, 1u));
      }
      out.irradiance[row] = irradiance;
      out.error[row] = static_cast<float>(std::sqrt(variance));
    }
    ray_count += cast;
  });
  return ray_count;
}

}  // namespace patchlight
