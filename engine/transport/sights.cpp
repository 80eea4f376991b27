// Receivers and groups of emitters to who may see what, by rays.
#include "engine/transport/sights.h"

#include "engine/base/parallel.h"
#include "engine/base/union_find.h"
#include "engine/mesh/buried.h"
#include "engine/mesh/cell_rays.h"

#include <array>
#include <atomic>
#include <bit>

namespace patchlight {
namespace {

// Above this mean share of its sky a polygon leaves emitters to its rows: closed rooms in which all emits
// come out exact then.
constexpr double kEmitterSkyMax = 0.8;
// Rays from a receiver at a group: at first, and in all where some arrive and some do not.
constexpr uint32_t kFirstPackets = 4, kMixedPackets = 16;
// A group that gives less than this share of a receiver's light, blockers aside, gets the first rays only.
constexpr float kWeakShare = 0.03f;

struct Look {
  uint64_t reached = 0;  // pieces that a ray has reached
  uint32_t rays = 0, arrived = 0;
};

// One packet of rays from a receiver at the pieces of a group in turn.
void look(Look& sum, const Casters& from, uint32_t receiver, bool buried, const EmitterGroups& groups,
          size_t group, uint64_t key, uint32_t packet) {
  const FaceFrameTable& frames = from.surfaces.frames;
  const uint32_t first = groups.piece_first[group], count = groups.piece_count(group);
  RayPacket rays;
  std::array<uint32_t, kPacketSize> piece;
  uint32_t active = 0;
  Vec3 any_normal(0);
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t index = packet * kPacketSize + k;
    const Vec2 a = make_jitter(key, 2 * index), b = make_jitter(key, 2 * index + 1);
    // Consecutive rays part: origins by strata of 4 x 4, pieces evenly.
    const Vec2 place((static_cast<float>(k % 4) + a.x) * 0.25f, (static_cast<float>(k / 4) + a.y) * 0.25f);
    const Origin origin = find_origin(from, receiver, place);
    // A prime strides through all of them, but through no multiple of itself.
    piece[k] = (index * (count == 37 ? 41u : 37u) + packet) % count;
    const Emitter& emitter = groups.pieces[first + piece[k]];
    const Vec2 uv = cell_sample(frames.triangle[emitter.face], emitter.cell, b);
    const Vec3 start = origin.point + ray_offset(origin.point) * origin.normal;
    const Vec3 point = face_point(frames, emitter.face, uv);
    const Vec3 way = point + ray_offset(start, point) * emitter.normal - start;
    any_normal = origin.normal;
    if (dot(way, origin.normal) > 0 && dot(way, emitter.normal) < 0) active |= 1u << k;
    rays.origin_x[k] = start.x, rays.origin_y[k] = start.y, rays.origin_z[k] = start.z;
    rays.direction_x[k] = way.x, rays.direction_y[k] = way.y, rays.direction_z[k] = way.z;
    rays.near_distance[k] = 0, rays.far_distance[k] = 1;
  }
  if (buried && active) active &= ~find_buried(from.surfaces, make_frame(any_normal), rays, active);
  if (!active) return;
  const uint32_t reached = active & ~find_blocked(from.surfaces.tracer, rays, active, RayOrder::kIncoherent);
  for (uint32_t k = 0; k < kPacketSize; ++k)
    if (reached >> k & 1u) sum.reached |= uint64_t{1} << piece[k];
  sum.rays += static_cast<uint32_t>(std::popcount(active));
  sum.arrived += static_cast<uint32_t>(std::popcount(reached));
}

// Receivers of patches beside the patches of each receiver: CSR.
void find_receiver_neighbours(std::vector<uint32_t>& first, std::vector<uint32_t>& other,
                              const Casters& from) {
  const ReceiverTable& receivers = from.receivers;
  std::vector<std::vector<uint32_t>> beside(receivers.size());
  for_rows(receivers.size(), 256, [&](size_t begin, size_t end) {
    for (size_t r = begin; r < end; ++r) {
      for (uint32_t k = receivers.first[r]; k < receivers.first[r + 1]; ++k) {
        const uint32_t p = receivers.patch[k], face = from.patches.face[p];
        for (uint32_t edge = 0; edge < edge_count(from.surfaces.frames, face); ++edge)
          for (const uint32_t q :
               find_neighbours(from.patches, from.surfaces.frames, from.surfaces.links, p, edge))
            if (q != kNone && receivers.receiver_of[q] != r) beside[r].push_back(receivers.receiver_of[q]);
      }
      std::sort(beside[r].begin(), beside[r].end());
      beside[r].erase(std::unique(beside[r].begin(), beside[r].end()), beside[r].end());
    }
  });
  first.assign(1, 0);
  other.clear();
  for (const auto& row : beside) {
    other.insert(other.end(), row.begin(), row.end());
    first.push_back(static_cast<uint32_t>(other.size()));
  }
}

}  // namespace

std::vector<uint8_t> find_aiming(const Surfaces& surfaces, const EmitterGroups& groups,
                                 const PatchTable& patches, const ReceiverTable& receivers) {
  const FaceTable& faces = surfaces.faces;
  const size_t count = faces.size() ? faces.polygon.back() + 1 : 0;
  UnionFind sets(count);
  for (size_t r = 0; r < receivers.size(); ++r)
    for (uint32_t k = receivers.first[r] + 1; k < receivers.first[r + 1]; ++k)
      sets.join(faces.polygon[patches.face[receivers.patch[k - 1]]],
                faces.polygon[patches.face[receivers.patch[k]]]);
  std::vector<std::vector<uint32_t>> rows(count);
  for (uint32_t row = 0; row < patches.size(); ++row)
    rows[sets.find(faces.polygon[patches.face[row]])].push_back(row);
  std::vector<uint8_t> aiming(count, 1);
  const size_t probes = std::clamp(65536 / std::max(groups.pieces.size(), size_t{1}), size_t{4}, size_t{64});
  for_rows(count, 4, [&](size_t begin, size_t end) {
    for (size_t polygon = begin; polygon < end; ++polygon) {
      double sky = 0, area = 0;
      const size_t step = std::max(rows[polygon].size() / probes, size_t{1});
      for (size_t k = 0; k < rows[polygon].size(); k += step) {
        const uint32_t row = rows[polygon][k], face = patches.face[row];
        const double exposed = patches.area[row] * patches.exposed[row];
        const Vec3 centre = cell_centre(surfaces.frames, face, patches.cell[row], patches.level[row]);
        area += exposed;
        for (const Emitter& piece : groups.pieces)
          if (piece.face != face) sky += exposed * find_point_factor(centre, faces.normal[face], piece);
      }
      aiming[polygon] = sky <= kEmitterSkyMax * area;
    }
  });
  for (uint32_t polygon = 0; polygon < count; ++polygon) aiming[polygon] = aiming[sets.find(polygon)];
  return aiming;
}

SightTable find_sights(const Casters& from, const EmitterGroups& groups, std::span<const uint8_t> aiming,
                       uint64_t& ray_count) {
  const ReceiverTable& receivers = from.receivers;
  const FaceTable& faces = from.surfaces.faces;
  const size_t count = receivers.size(), group_count = groups.size();
  std::vector<uint64_t> seen(count * group_count, 0);
  std::vector<uint8_t> clear(count * group_count, 0);
  std::atomic<uint64_t> cast{0};
  for_rows(count, 32, [&](size_t begin, size_t end) {
    std::array<float, kGroupPiecesMax> strength;
    std::vector<float> sums(group_count);
    uint64_t rays = 0;
    for (auto r = static_cast<uint32_t>(begin); r < end; ++r) {
      const uint32_t patch = receivers.patch[receivers.first[r]], face = from.patches.face[patch];
      if (!aiming[faces.polygon[face]]) continue;
      float exposed = 0, all = 0;
      for (uint32_t k = receivers.first[r]; k < receivers.first[r + 1]; ++k)
        exposed = std::max(exposed, from.patches.exposed[receivers.patch[k]]);
      if (exposed == 0) continue;
      const bool buried = exposed < 1;
      for (size_t g = 0; g < group_count; ++g)
        all += sums[g] = find_strengths(strength, groups, g, receivers.centre[r], receivers.normal[r]);
      for (size_t g = 0; g < group_count; ++g) {
        const uint64_t key = mix_bits(
            make_ray_key(from.seed, face, from.patches.cell[patch], from.patches.level[patch], kSightRays) +
            g);
        Look sum;
        for (uint32_t packet = 0; packet < kFirstPackets; ++packet)
          look(sum, from, r, buried, groups, g, key, packet);
        const bool weak = sums[g] < kWeakShare * all;
        if (!weak && sum.rays > 0 && sum.arrived < sum.rays)
          for (uint32_t packet = kFirstPackets; packet < kMixedPackets; ++packet)
            look(sum, from, r, buried, groups, g, key, packet);
        rays += sum.rays;
        seen[r * group_count + g] = sum.reached;
        clear[r * group_count + g] = sum.rays > 0 && sum.arrived == sum.rays && !buried;
      }
    }
    cast += rays;
  });
  ray_count += cast;
  // A receiver may see what its neighbours see.
  std::vector<uint32_t> beside_first, beside;
  find_receiver_neighbours(beside_first, beside, from);
  std::vector<uint64_t> joined = seen;
  std::vector<uint8_t> all_clear = clear;
  for_rows(count, 256, [&](size_t begin, size_t end) {
    for (size_t r = begin; r < end; ++r)
      for (uint32_t k = beside_first[r]; k < beside_first[r + 1]; ++k)
        for (size_t g = 0; g < group_count; ++g) {
          joined[r * group_count + g] |= seen[beside[k] * group_count + g];
          // Beyond a horizon nothing was asked.
          all_clear[r * group_count + g] &= clear[beside[k] * group_count + g];
        }
  });
  SightTable sights;
  sights.first.push_back(0);
  for (size_t r = 0; r < count; ++r) {
    for (size_t g = 0; g < group_count; ++g) {
      const size_t at = r * group_count + g;
      if (!joined[at]) continue;
      // Of a piece of which little is seen no ray may have told.
      uint64_t pieces = 0;
      for (uint64_t rest = joined[at]; rest != 0; rest &= rest - 1)
        pieces |= groups.beside[groups.piece_first[g] + static_cast<uint32_t>(std::countr_zero(rest))];
      sights.group.push_back(static_cast<uint32_t>(g));
      sights.clear.push_back(all_clear[at]);
      sights.pieces.push_back(all_clear[at] ? groups.all_pieces(g) : pieces);
    }
    sights.first.push_back(static_cast<uint32_t>(sights.group.size()));
  }
  return sights;
}

SightTable inherit_sights(const SightTable& before, std::span<const uint32_t> receiver_before) {
  SightTable sights;
  sights.first.push_back(0);
  for (const uint32_t r : receiver_before) {
    for (uint32_t k = before.first[r]; k < before.first[r + 1]; ++k) {
      sights.group.push_back(before.group[k]);
      sights.pieces.push_back(before.pieces[k]);
      sights.clear.push_back(before.clear[k]);
    }
    sights.first.push_back(static_cast<uint32_t>(sights.group.size()));
  }
  return sights;
}

}  // namespace patchlight
