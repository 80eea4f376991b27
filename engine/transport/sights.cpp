// Receivers and groups of emitters to who may see what, by rays.
#include "engine/transport/sights.h"

#include "engine/base/parallel.h"
#include "engine/mesh/buried.h"
#include "engine/mesh/cell_rays.h"

#include <array>
#include <atomic>
#include <bit>
#include <span>

namespace patchlight {
namespace {

// Rays from a receiver at a group: at first, and in all where some do not arrive; at the sun, whose spots may
// be small.
constexpr uint32_t kFirstPackets = 4, kMorePackets = 8, kSunPackets = 16;
// Rays at a group of the sky by which is told whether anything of it, or of one beside it, may be seen.
constexpr uint32_t kGlancePackets = 2;
constexpr size_t kFewGroups = 8;
// A group that gives less than this share of a receiver's light, blockers aside, gets the first rays only.
constexpr float kWeakShare = 0.03f;

struct Look {
  uint64_t reached = 0;  // pieces that a ray has reached
  uint32_t rays = 0, arrived = 0;
};

// Receivers that look together, and so see alike: those of patches beside one another on a face.
struct Looker {
  uint32_t first, last;  // receivers
  bool shared;           // one, of several patches
  uint32_t size() const { return last - first; }
};
std::vector<Looker> make_lookers(const Casters& from) {
  const ReceiverTable& receivers = from.receivers;
  const auto is_single = [&](uint32_t r) { return receivers.first[r + 1] - receivers.first[r] == 1; };
  // Four that were one patch before they were split.
  const auto is_sibling = [&](uint32_t a, uint32_t b) {
    const uint32_t p = receivers.patch[receivers.first[a]], q = receivers.patch[receivers.first[b]];
    const uint32_t level = from.patches.level[p];
    return level > 0 && from.patches.face[p] == from.patches.face[q] && from.patches.level[q] == level &&
           cell_ancestor(from.patches.cell[p], level - 1) == cell_ancestor(from.patches.cell[q], level - 1);
  };
  std::vector<Looker> lookers;
  for (uint32_t r = 0; r < receivers.size(); ++r) {
    const bool goes_on = r > 0 && is_single(r) && is_single(r - 1) && is_sibling(lookers.back().first, r);
    if (goes_on)
      lookers.back().last = r + 1;
    else
      lookers.push_back({r, r + 1, !is_single(r)});
  }
  return lookers;
}

// Where a looker's rays start: sixteen points of its receivers, just off their faces, and the normals there.
struct Starts {
  std::array<float, kPacketSize> normal_x, normal_y, normal_z;
};
// samples: two numbers a ray: consecutive rays part, origins by strata of 4 x 4.
void make_starts(Starts& starts, RayPacket& rays, const Casters& from, const Looker& looker, uint32_t packet,
                 std::span<const Vec2, kPacketSize> samples) {
  const auto place = [&](uint32_t k) {
    return Vec2((static_cast<float>(k % 4) + samples[k].x) * 0.25f,
                (static_cast<float>(k / 4) + samples[k].y) * 0.25f);
  };
  const auto set = [&](uint32_t k, Vec3 point, Vec3 normal) {
    const Vec3 start = point + ray_offset(point) * normal;
    rays.origin_x[k] = start.x, rays.origin_y[k] = start.y, rays.origin_z[k] = start.z;
    starts.normal_x[k] = normal.x, starts.normal_y[k] = normal.y, starts.normal_z[k] = normal.z;
  };
  if (looker.shared) {
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const Origin origin = find_origin(from, looker.first, place(k));
      set(k, origin.point, origin.normal);
    }
    return;
  }
  // Cells of one face.
  const FaceFrameTable& frames = from.surfaces.frames;
  const uint32_t patch = from.receivers.patch[from.receivers.first[looker.first]],
                 face = from.patches.face[patch];
  const bool triangle = frames.triangle[face];
  std::array<CellFrame, 4> cells;
  for (uint32_t m = 0; m < looker.size(); ++m) {
    const uint32_t p = from.receivers.patch[from.receivers.first[looker.first + m]];
    cells[m] = make_cell_frame(triangle, from.patches.cell[p], from.patches.level[p]);
  }
  const Vec3 normal = from.surfaces.faces.normal[face];
  for (uint32_t k = 0; k < kPacketSize; ++k)
    set(k,
        face_point(frames, face,
                   cell_sample(triangle, cells[(k + k / 4 + packet) % looker.size()], place(k))),
        normal);
}

// One packet of rays from a looker's receivers at the pieces of a group in turn.
void look(Look& sum, const Casters& from, const Looker& looker, bool buried, const EmitterGroups& groups,
          size_t group, uint64_t key, uint32_t packet) {
  const uint32_t count = groups.piece_count(group), first_ray = packet * kPacketSize;
  // A prime strides through all pieces, but through no multiple of itself.
  const uint32_t stride = (count == 37 ? 41u : 37u) % count;
  uint32_t next = (first_ray * stride + packet) % count;
  std::array<uint32_t, kPacketSize> piece;
  std::array<Vec2, kPacketSize> place;
  std::array<float, kPacketSize> u, v, sent, cosine;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const std::array<float, 4> sample = make_jitter4(key, first_ray + k);
    place[k] = {sample[0], sample[1]};
    u[k] = sample[2], v[k] = sample[3];
    piece[k] = next;
    next += stride;
    if (next >= count) next -= count;
  }
  RayPacket rays;
  Starts starts;
  make_starts(starts, rays, from, looker, packet, place);
  std::array<uint32_t, kPacketSize> row = piece;
  if (groups.is_sky(group)) {
    for (uint32_t& k : row) k += groups.sky_first(group);
    aim_at_sky(rays, sent, groups.sky, from.surfaces.sky, row, u, v);
  } else {
    for (uint32_t& k : row) k += groups.piece_first[group];
    aim_at_pieces(rays, sent, groups, row, u, v);
  }
  for (uint32_t k = 0; k < kPacketSize; ++k)
    cosine[k] = std::min(rays.direction_x[k] * starts.normal_x[k] + rays.direction_y[k] * starts.normal_y[k] +
                             rays.direction_z[k] * starts.normal_z[k],
                         sent[k]);
  uint32_t active = find_positive(cosine);
  if (buried && active) {
    const Vec3 normal(starts.normal_x[0], starts.normal_y[0], starts.normal_z[0]);
    active &= ~find_buried(from.surfaces, make_frame(normal), rays, active);
  }
  if (!active) return;
  const uint32_t reached = active & ~find_blocked(from.surfaces.tracer, rays, active, RayOrder::kIncoherent);
  for (uint32_t k = 0; k < kPacketSize; ++k) sum.reached |= uint64_t{reached >> k & 1u} << piece[k];
  sum.rays += static_cast<uint32_t>(std::popcount(active));
  sum.arrived += static_cast<uint32_t>(std::popcount(reached));
}

// What a group of the sky brings to a receiver at most.
float find_sky_strength(SkyIrradiance& sky, const EmitterGroups& groups, size_t group,
                        const Surfaces& surfaces, Vec3 normal) {
  const uint32_t first = groups.sky_first(group), last = first + groups.piece_count(group);
  find_sky_irradiance(sky, groups.sky, surfaces.sky, normal, first, last);
  float sum = 0;
  for (uint32_t row = first; row < last; ++row) sum += sky.strength[row];
  return sum;
}

// Of a piece of which little is seen no ray may have told: those beside one that is seen count as seen, too.
// Twice over, half as many rays lose no more.
// seen: of one receiver, a row a group.
void widen(std::span<uint64_t> widened, std::span<const uint64_t> seen, const EmitterGroups& groups) {
  for (size_t g = 0; g < groups.size(); ++g) widened[g] = 0;
  for (size_t g = 0; g < groups.size(); ++g)
    for (uint64_t rest = seen[g]; rest != 0; rest &= rest - 1)
      widened[g] |= groups.beside[groups.piece_first[g] + static_cast<uint32_t>(std::countr_zero(rest))];
  // Cells of the sky also lie beside those of other groups, which are of 64 each.
  for (size_t g = groups.lamp_group_count(); g < groups.size(); ++g) {
    if (groups.is_sun(g)) continue;
    for (uint64_t rest = seen[g]; rest != 0; rest &= rest - 1) {
      const uint32_t row = groups.sky_first(g) + static_cast<uint32_t>(std::countr_zero(rest));
      for (uint32_t k = groups.sky.beside_first[row]; k < groups.sky.beside_first[row + 1]; ++k)
        widened[groups.lamp_group_count() + groups.sky.beside[k] / kGroupPiecesMax] |=
            uint64_t{1} << groups.sky.beside[k] % kGroupPiecesMax;
    }
  }
}

// Groups of the sky beside each of them, itself included; those of lamps have none.
std::vector<std::vector<size_t>> find_groups_beside(const EmitterGroups& groups) {
  std::vector<std::vector<size_t>> beside(groups.size());
  for (size_t g = groups.lamp_group_count(); g < groups.size(); ++g) {
    std::vector<size_t>& list = beside[g];
    for (uint32_t row = groups.sky_first(g); row < groups.sky_first(g) + groups.piece_count(g); ++row)
      for (uint32_t k = groups.sky.beside_first[row]; k < groups.sky.beside_first[row + 1]; ++k)
        list.push_back(groups.lamp_group_count() + groups.sky.beside[k] / kGroupPiecesMax);
    list.push_back(g);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return beside;
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

// Adds the pieces that rows have met, where they are to be aimed at. seen: a row a receiver and group. Rays
// that start within a solid may meet a lamp that dips into it.
void add_row_hits(std::span<uint64_t> seen, const Rows& rows, const EmitterGroups& groups,
                  std::span<const float> emission_by_rows) {
  const PatchTable& patches = rows.by.patches;
  const FaceTable& faces = rows.by.surfaces.faces;
  if (groups.lamp_group_count() == 0) return;
  // Few patches emit: a byte a patch stays in the cache.
  std::vector<uint8_t> emits(patches.size());
  for (size_t p = 0; p < emits.size(); ++p) emits[p] = largest(faces.emission[patches.face[p]]) > 0;
  for_rows(rows.by.receivers.size(), 64, [&](size_t begin, size_t end) {
    RowScratch scratch;
    for (auto row = static_cast<uint32_t>(begin); row < end; ++row) {
      if (rows.hits.buried[row]) continue;
      const uint32_t own = rows.by.receivers.patch[rows.by.receivers.first[row]];
      const float by_rows = emission_by_rows[faces.polygon[patches.face[own]]];
      const RowHits hits = find_row(scratch, rows, row);
      for (size_t k = 0; k < hits.patch.size(); ++k) {
        const uint32_t patch = hits.patch[k];
        if (patch >= kHitBuried || !emits[patch]) continue;
        const uint32_t face = patches.face[patch];
        const uint32_t piece = find_piece(groups, face, hits.cell[k]);
        if (piece == kNone || luminance(faces.emission[face]) <= by_rows) continue;
        const uint32_t group = groups.group_of[piece];
        seen[row * groups.size() + group] |= uint64_t{1} << (piece - groups.piece_first[group]);
      }
    }
  });
}

}  // namespace

SightTable find_sights(const Rows& rows, const EmitterGroups& groups, std::span<const float> emission_by_rows,
                       uint64_t& ray_count) {
  const Casters& from = rows.by;
  const ReceiverTable& receivers = from.receivers;
  const FaceTable& faces = from.surfaces.faces;
  const size_t count = receivers.size(), group_count = groups.size();
  const std::vector<Looker> lookers = make_lookers(from);
  std::vector<uint64_t> seen(count * group_count, 0);
  std::vector<uint8_t> clear(count * group_count, 0);
  const std::vector<std::vector<size_t>> beside_group = find_groups_beside(groups);
  std::atomic<uint64_t> cast{0};
  for_rows(lookers.size(), 8, [&](size_t begin, size_t end) {
    std::array<float, kGroupPiecesMax> strength;
    SkyIrradiance sky;
    std::vector<Look> looks;
    std::vector<uint8_t> glimpsed, is_looked_at;
    std::vector<size_t> asked;  // groups
    std::vector<float> sums(group_count);
    uint64_t rays = 0;
    for (size_t l = begin; l < end; ++l) {
      const Looker& looker = lookers[l];
      const uint32_t r = looker.first, patch = receivers.patch[receivers.first[r]];
      const uint32_t face = from.patches.face[patch];
      // The lamps that are aimed at come first, and all look at the sky: rows tell nothing of it.
      const float by_rows = emission_by_rows[faces.polygon[face]];
      size_t lamp_end = 0;
      while (lamp_end < groups.lamp_group_count() && groups.brightest[lamp_end] > by_rows) ++lamp_end;
      const size_t sky_first = groups.lamp_group_count();
      if (lamp_end == 0 && sky_first == group_count) continue;
      asked.clear();
      for (size_t g = 0; g < lamp_end; ++g) asked.push_back(g);
      for (size_t g = sky_first; g < group_count; ++g) asked.push_back(g);
      float least_exposed = 1, most_exposed = 0, sky_sum = 0;
      Vec3 centre(0);
      for (uint32_t member = r; member < looker.last; ++member) {
        float exposed = 0;
        for (uint32_t k = receivers.first[member]; k < receivers.first[member + 1]; ++k)
          exposed = std::max(exposed, from.patches.exposed[receivers.patch[k]]);
        least_exposed = std::min(least_exposed, exposed), most_exposed = std::max(most_exposed, exposed);
        centre += receivers.centre[member] / static_cast<float>(looker.size());
      }
      if (most_exposed == 0) continue;
      const bool buried = least_exposed < 1;
      for (const size_t g : asked) {
        sums[g] = groups.is_sky(g) ? find_sky_strength(sky, groups, g, from.surfaces, receivers.normal[r])
                                   : find_strengths(strength, groups, g, centre, receivers.normal[r]);
        if (groups.is_sky_cells(g)) sky_sum += sums[g];
      }
      const bool single = receivers.first[r + 1] - receivers.first[r] == 1;
      looks.assign(group_count, {});
      const auto look_at = [&](size_t g, uint32_t first, uint32_t last) {
        const uint64_t key = mix_bits(
            make_ray_key(from.seed, face, from.patches.cell[patch], from.patches.level[patch], kSightRays) +
            g);
        for (uint32_t packet = first; packet < last; ++packet)
          look(looks[g], from, looker, buried, groups, g, key, packet);
      };
      const auto is_below = [&](size_t g) { return groups.is_sky(g) && single && sums[g] == 0; };
      // A glance at all of the sky, for most of it is hidden from most; then at what may be seen.
      for (size_t g = sky_first; g < group_count; ++g)
        if (!is_below(g)) look_at(g, 0, kGlancePackets);
      const auto is_glimpsed = [&](size_t g) { return glimpsed[g] != 0; };
      glimpsed.assign(group_count, 0);
      is_looked_at.assign(group_count, 0);
      size_t glimpsed_count = 0;
      for (const size_t g : asked) {
        glimpsed[g] = looks[g].arrived > 0;
        glimpsed_count += glimpsed[g];
      }
      for (const size_t g : asked) {
        if (is_below(g) || (groups.is_sky_cells(g) &&
                            std::none_of(beside_group[g].begin(), beside_group[g].end(), is_glimpsed))) {
          rays += looks[g].rays;
          continue;
        }
        // A spot of the sun may be small on a large patch, and is bright.
        look_at(g, groups.is_sky(g) ? kGlancePackets : 0, groups.is_sun(g) ? kSunPackets : kFirstPackets);
        is_looked_at[g] = 1;
      }
      // What is hidden, however strong, says nothing of what counts.
      float all = 0;
      for (const size_t g : asked)
        if (looks[g].arrived > 0) all += sums[g];
      for (const size_t g : asked) {
        if (!is_looked_at[g]) continue;
        const Look& sum = looks[g];
        // Through a window few groups of the sky are seen, and all of them count.
        const bool weak = groups.is_sky_cells(g)
                              ? glimpsed_count > kFewGroups && sums[g] < kWeakShare * sky_sum
                              : sums[g] < kWeakShare * all;
        if (!weak && !groups.is_sun(g) && sum.rays > 0 && sum.arrived < sum.rays)
          look_at(g, kFirstPackets, kMorePackets);
        rays += sum.rays;
        for (size_t member = r; member < looker.last; ++member) {
          seen[member * group_count + g] = sum.reached;
          clear[member * group_count + g] = sum.rays > 0 && sum.arrived == sum.rays && !buried;
        }
      }
    }
    cast += rays;
  });
  ray_count += cast;
  add_row_hits(seen, rows, groups, emission_by_rows);
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
  std::vector<uint64_t> once(group_count), widened(group_count);
  for (size_t r = 0; r < count; ++r) {
    widen(once, std::span(joined).subspan(r * group_count, group_count), groups);
    widen(widened, once, groups);
    for (size_t g = 0; g < group_count; ++g) {
      if (!widened[g]) continue;
      const bool is_clear = all_clear[r * group_count + g] != 0;
      sights.group.push_back(static_cast<uint32_t>(g));
      sights.clear.push_back(is_clear);
      sights.pieces.push_back(is_clear ? groups.all_pieces(g) : widened[g]);
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
