// Patches to rows of ray hits.
#include "rows.h"

#include "parallel.h"
#include "quadtree.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <numeric>

namespace patchlight {
namespace {

constexpr uint32_t kProbeRays = 32;
// Of the square root of the scene's area: a patch is never larger, and not split below the smallest.
constexpr float kPatchEdgeMax = 0.06f;
constexpr float kPatchEdgeMin = 0.006f;
constexpr float kPatchEdgeMinAtSolid = 0.003f;
// A patch's edge over the harmonic mean distance of what it sees (Ward, Heckbert: Irradiance Gradients, 1992,
// use the same mean for the reach of a sample).
constexpr float kPatchEdgePerDistance = 0.25f;

// The step for which the lattice (k, k * step mod count) fills the square most evenly: its shortest vector is
// longest.
uint32_t find_lattice_step(uint32_t count) {
  uint32_t best = 1, best_length = 0;
  for (uint32_t step = 1; step < count; ++step) {
    if (std::gcd(step, count) != 1) continue;
    uint32_t shortest = ~0u;
    for (uint32_t k = 1; k < count; ++k) {
      const uint32_t up = k * step % count, along = std::min(k, count - k), across = std::min(up, count - up);
      shortest = std::min(shortest, along * along + across * across);
    }
    if (shortest > best_length) best = step, best_length = shortest;
  }
  return best;
}

// Malley's direction from a point of the unit square, as make_cosine_direction, but a loop over lanes of it
// compiles to wide instructions: no branches, sine and cosine as polynomials (|angle| <= pi / 4, error below
// 4e-7).
inline Vec3 make_local_direction(float px, float py) {
  const float a = 2 * px - 1, b = 2 * py - 1;
  const bool wide = std::abs(a) > std::abs(b);
  const float radius = wide ? a : b, minor = wide ? b : a;
  const float x = kPi / 4 * minor / (radius == 0 ? 1 : radius), xx = x * x;
  const float sine = x * (1 + xx * (-1 / 6.0f + xx * (1 / 120.0f - xx / 5040.0f)));
  const float cosine = 1 + xx * (-0.5f + xx * (1 / 24.0f + xx * (-1 / 720.0f + xx / 40320.0f)));
  const float along = radius * cosine, across = radius * sine;
  const float u = wide ? along : across, v = wide ? across : along;
  return {u, v, std::sqrt(std::max(1 - u * u - v * v, 1e-9f))};
}

}  // namespace

RowGrid make_row_grid(uint32_t rays) {
  const auto side = static_cast<uint32_t>(std::lround(std::sqrt(static_cast<double>(rays)) / 4));
  const uint32_t columns = 4 * std::max(side, 1u);
  const uint32_t rows = 4 * std::max((rays + 2 * columns) / (4 * columns), 1u);
  return {columns, rows, find_lattice_step(columns), find_lattice_step(rows)};
}

void make_row_packet(HitPacket& rays, const FaceFrameTable& frames, const Frame& frame, uint32_t face,
                     uint32_t cell, uint32_t level, uint64_t row_key, RowGrid grid, uint32_t packet) {
  const bool triangle = frames.triangle[face];
  const CellFrame place = make_cell_frame(triangle, cell, level);
  const uint32_t tile_columns = grid.columns / 4;
  const uint32_t column = 4 * (packet % tile_columns), row = 4 * (packet / tile_columns);
  const uint32_t shift_u = static_cast<uint32_t>(row_key) % grid.rows;
  const uint32_t shift_v = static_cast<uint32_t>(row_key >> 32) % grid.columns;
  const float scale_x = 1 / static_cast<float>(grid.columns), scale_y = 1 / static_cast<float>(grid.rows);
  // Loops over lanes stand alone, so that they compile to wide instructions: hashing, directions, origins.
  float direction_x[kPacketSize], direction_y[kPacketSize], origin_s[kPacketSize], origin_t[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t a = column + k % 4, b = row + k / 4, index = b * grid.columns + a;
    const Vec2 d = make_jitter(row_key, 2 * index), o = make_jitter(row_key, 2 * index + 1);
    direction_x[k] = (static_cast<float>(a) + d.x) * scale_x;
    direction_y[k] = (static_cast<float>(b) + d.y) * scale_y;
    // Every packet's sixteen origins are spread over the whole patch, and every stratum of the patch is used
    // once.
    const uint32_t c = (b * grid.row_step + shift_u) % grid.rows;
    const uint32_t e = (a * grid.column_step + shift_v) % grid.columns;
    const Vec2 uv = cell_sample(
        triangle, place, {(static_cast<float>(c) + o.x) * scale_y, (static_cast<float>(e) + o.y) * scale_x});
    origin_s[k] = uv.x, origin_t[k] = uv.y;
  }
  const Vec3 corner = frames.origin[face], u = frames.edge_u[face], v = frames.edge_v[face],
             twist = frames.twist[face];
  const Vec3 tangent = frame.tangent, bitangent = frame.bitangent, normal = frame.normal;
  RayPacket& ray = rays.ray;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec3 local = make_local_direction(direction_x[k], direction_y[k]);
    ray.direction_x[k] = local.x * tangent.x + local.y * bitangent.x + local.z * normal.x;
    ray.direction_y[k] = local.x * tangent.y + local.y * bitangent.y + local.z * normal.y;
    ray.direction_z[k] = local.x * tangent.z + local.y * bitangent.z + local.z * normal.z;
    ray.near_distance[k] = 0, ray.far_distance[k] = std::numeric_limits<float>::infinity();
  }
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float s = origin_s[k], t = origin_t[k], st = s * t;
    const Vec3 p(corner.x + s * u.x + t * v.x + st * twist.x, corner.y + s * u.y + t * v.y + st * twist.y,
                 corner.z + s * u.z + t * v.z + st * twist.z);
    const float offset = ray_offset(p);
    ray.origin_x[k] = p.x + offset * normal.x, ray.origin_y[k] = p.y + offset * normal.y;
    ray.origin_z[k] = p.z + offset * normal.z;
  }
}

uint32_t find_buried(const Tracer& tracer, const FaceTable& faces, const Frame& frame, const RayPacket& rays,
                     uint32_t active) {
  // Along the normal, at 60 degrees to it on three sides, at 82 degrees on three more: what lies under a
  // sheet sees out at its sides.
  constexpr float kTurnCosine = -0.5f, kTurnSine = 0.8660254f;
  constexpr float kSteepSine = 0.8660254f, kSteepCosine = 0.5f, kFlatSine = 0.9902681f,
                  kFlatCosine = 0.1391731f;
  constexpr float kAround[7][3] = {{0, 0, 1},
                                   {kSteepSine, 0, kSteepCosine},
                                   {kTurnCosine * kSteepSine, kTurnSine * kSteepSine, kSteepCosine},
                                   {kTurnCosine * kSteepSine, -kTurnSine * kSteepSine, kSteepCosine},
                                   {-kFlatSine, 0, kFlatCosine},
                                   {-kTurnCosine * kFlatSine, kTurnSine * kFlatSine, kFlatCosine},
                                   {-kTurnCosine * kFlatSine, -kTurnSine * kFlatSine, kFlatCosine}};
  for (const auto& local : kAround) {
    if (!active) break;
    const Vec3 direction = local[0] * frame.tangent + local[1] * frame.bitangent + local[2] * frame.normal;
    HitPacket probe;
    probe.ray = rays;
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      probe.ray.direction_x[k] = direction.x, probe.ray.direction_y[k] = direction.y;
      probe.ray.direction_z[k] = direction.z;
      probe.ray.near_distance[k] = 0, probe.ray.far_distance[k] = std::numeric_limits<float>::infinity();
    }
    find_hits(tracer, probe, active);
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (probe.face[k] == kNone || dot(direction, faces.normal[probe.face[k]]) < 0) active &= ~(1u << k);
  }
  return active;
}

uint64_t cast_rows(HitTable& hits, PatchTable& patches, const FaceTable& faces, const FaceFrameTable& frames,
                   const Tracer& tracer, uint32_t rays, uint64_t seed) {
  const RowGrid grid = make_row_grid(rays);
  hits.ray_count = grid.ray_count();
  hits.patch.resize(patches.size() * hits.ray_count);
  hits.cell.resize(patches.size() * hits.ray_count);
  for_rows(patches.size(), 16, [&](size_t begin, size_t end) {
    HitPacket packet;
    for (size_t row = begin; row < end; ++row) {
      const uint32_t face = patches.face[row];
      const Frame frame = make_frame(faces.normal[face]);
      const uint64_t key = make_row_key(seed, face, patches.cell[row], patches.level[row], kRowHits);
      uint32_t buried_count = 0;
      for (uint32_t tile = 0; tile < grid.packet_count(); ++tile) {
        make_row_packet(packet, frames, frame, face, patches.cell[row], patches.level[row], key, grid, tile);
        find_hits(tracer, packet, 0xffff);
        const size_t first = row * hits.ray_count + tile * kPacketSize;
        uint32_t back = 0;
        for (uint32_t k = 0; k < kPacketSize; ++k) {
          const uint32_t seen = packet.face[k];
          hits.patch[first + k] = kHitNothing;
          hits.cell[first + k] = 0;
          if (seen == kNone) continue;
          const RayPacket& r = packet.ray;
          const Vec3 direction(r.direction_x[k], r.direction_y[k], r.direction_z[k]);
          if (dot(direction, faces.normal[seen]) >= 0) {
            hits.patch[first + k] = kHitBack;
            back |= 1u << k;
            continue;
          }
          const Vec3 point =
              Vec3(r.origin_x[k], r.origin_y[k], r.origin_z[k]) + r.far_distance[k] * direction;
          const uint32_t cell = find_cell(frames.triangle[seen], find_face_parameters(frames, seen, point));
          hits.patch[first + k] = find_leaf(patches, seen, cell);
          hits.cell[first + k] = cell;
        }
        if (back) {
          const uint32_t buried = find_buried(tracer, faces, frame, packet.ray, back);
          for (uint32_t k = 0; k < kPacketSize; ++k)
            if (buried >> k & 1u) hits.patch[first + k] = kHitBuried, ++buried_count;
        }
      }
      patches.exposed[row] = 1 - static_cast<float>(buried_count) / static_cast<float>(hits.ray_count);
    }
  });
  return uint64_t{hits.ray_count} * patches.size();
}

PatchTable make_patches(const FaceTable& faces, const FaceFrameTable& frames, const FaceLinkTable& links,
                        const Tracer& tracer, uint64_t patch_count_max, uint64_t seed, uint64_t& ray_count) {
  double area = 0;
  for (uint32_t f = 0; f < faces.size(); ++f) area += cell_area(frames, f, 0, 0);
  const float scale = static_cast<float>(std::sqrt(area));
  PatchTable patches = make_leaves(faces, frames, [&](uint32_t face) {
    uint32_t level = 0;
    float edge = longest_edge(cell_corners(frames, face, 0, 0));
    while (edge > kPatchEdgeMax * scale && level < kLevelMax &&
           (faces.size() << 2 * level) < patch_count_max / 4)
      edge /= 2, ++level;
    return level;
  });
  balance_leaves(patches, frames, links);
  const RowGrid grid = make_row_grid(kProbeRays);
  std::vector<uint8_t> fresh(patches.size(), 1);
  for (;;) {
    std::vector<uint8_t> marks(patches.size(), 0);
    std::atomic<uint64_t> probed{0}, marked{0};
    for_rows(patches.size(), 64, [&](size_t begin, size_t end) {
      HitPacket packet;
      for (size_t row = begin; row < end; ++row) {
        const uint32_t face = patches.face[row], cell = patches.cell[row], level = patches.level[row];
        const float edge = longest_edge(cell_corners(frames, face, cell, level));
        if (!fresh[row] || level >= kLevelMax - 2 || edge < 2 * kPatchEdgeMinAtSolid * scale) continue;
        const Frame frame = make_frame(faces.normal[face]);
        const uint64_t key = make_row_key(seed, face, cell, level, kRowProbe);
        float inverse_sum = 0;
        uint32_t buried_count = 0;
        for (uint32_t tile = 0; tile < grid.packet_count(); ++tile) {
          make_row_packet(packet, frames, frame, face, cell, level, key, grid, tile);
          find_hits(tracer, packet, 0xffff);
          uint32_t back = 0;
          for (uint32_t k = 0; k < kPacketSize; ++k) {
            if (packet.face[k] == kNone) continue;
            inverse_sum += 1 / std::max(packet.ray.far_distance[k], 1e-6f);
            const RayPacket& r = packet.ray;
            const Vec3 direction(r.direction_x[k], r.direction_y[k], r.direction_z[k]);
            if (dot(direction, faces.normal[packet.face[k]]) >= 0) back |= 1u << k;
          }
          if (back) buried_count += std::popcount(find_buried(tracer, faces, frame, packet.ray, back));
        }
        probed += grid.ray_count();
        const bool at_solid = buried_count > 0 && buried_count < grid.ray_count();
        const bool near = edge * inverse_sum > kPatchEdgePerDistance * static_cast<float>(grid.ray_count());
        const float edge_min = (at_solid ? kPatchEdgeMinAtSolid : kPatchEdgeMin) * scale;
        if (buried_count == grid.ray_count() || !(near || at_solid) || edge < 2 * edge_min) continue;
        marks[row] = 1;
        ++marked;
      }
    });
    ray_count += probed;
    if (!marked || patches.size() + 3 * marked > patch_count_max) return patches;
    mark_for_balance(marks, patches, frames, links);
    std::vector<uint32_t> parent;
    const PatchTable before = std::move(patches);
    patches = split_leaves(before, frames, marks, parent);
    fresh.assign(patches.size(), 0);
    for (size_t row = 0; row < patches.size(); ++row) fresh[row] = marks[parent[row]];
  }
}

}  // namespace patchlight
