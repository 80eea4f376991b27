// Cells to packets of rays.
#include "engine/mesh/cell_rays.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace patchlight {
namespace {

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

}  // namespace

RayGrid make_ray_grid(uint32_t rays) {
  const auto side = static_cast<uint32_t>(std::lround(std::sqrt(static_cast<double>(rays)) / 4));
  const uint32_t columns = 4 * std::max(side, 1u);
  const uint32_t rows = 4 * std::max((rays + 2 * columns) / (4 * columns), 1u);
  return {columns, rows, find_lattice_step(columns), find_lattice_step(rows)};
}

void make_ray_samples(RaySamples& samples, uint64_t key, const RayGrid& grid, uint32_t packet) {
  const uint32_t tile_columns = grid.columns / 4;
  const uint32_t column = 4 * (packet % tile_columns), row = 4 * (packet / tile_columns);
  const uint32_t shift_u = static_cast<uint32_t>(key) % grid.rows;
  const uint32_t shift_v = static_cast<uint32_t>(key >> 32) % grid.columns;
  const float scale_x = 1 / static_cast<float>(grid.columns), scale_y = 1 / static_cast<float>(grid.rows);
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t a = column + k % 4, b = row + k / 4, index = b * grid.columns + a;
    const Vec2 d = make_jitter(key, 2 * index), o = make_jitter(key, 2 * index + 1);
    samples.direction_x[k] = (static_cast<float>(a) + d.x) * scale_x;
    samples.direction_y[k] = (static_cast<float>(b) + d.y) * scale_y;
    // Every packet's sixteen origins are spread over the whole patch, and every stratum of the patch is used
    // once.
    const uint32_t c = (b * grid.row_step + shift_u) % grid.rows;
    const uint32_t e = (a * grid.column_step + shift_v) % grid.columns;
    samples.origin_x[k] = (static_cast<float>(c) + o.x) * scale_y;
    samples.origin_y[k] = (static_cast<float>(e) + o.y) * scale_x;
  }
}

CellRays make_cell_rays(const FaceTable& faces, const CellName& cell, RayPurpose purpose, uint64_t seed,
                        const RayGrid& grid) {
  return {cell, make_frame(faces.normal[cell.face]),
          make_ray_key(seed, cell.face, cell.cell, cell.level, purpose), grid};
}

void make_ray_packet(HitPacket& rays, const CellRays& from, const FaceFrameTable& frames, uint32_t packet) {
  const auto& [face, cell, level] = from.cell;
  const Frame& frame = from.frame;
  const bool triangle = frames.triangle[face];
  const CellFrame place = make_cell_frame(triangle, cell, level);
  // Loops over lanes stand alone, so that they compile to wide instructions: hashing, directions, origins.
  RaySamples samples;
  make_ray_samples(samples, from.key, from.grid, packet);
  float origin_s[kPacketSize], origin_t[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec2 uv = cell_sample(triangle, place, {samples.origin_x[k], samples.origin_y[k]});
    origin_s[k] = uv.x, origin_t[k] = uv.y;
  }
  const Vec3 corner = frames.origin[face], u = frames.edge_u[face], v = frames.edge_v[face],
             twist = frames.twist[face];
  const Vec3 tangent = frame.tangent, bitangent = frame.bitangent, normal = frame.normal;
  RayPacket& ray = rays.ray;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec3 local = make_cosine_direction(samples.direction_x[k], samples.direction_y[k]);
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

}  // namespace patchlight
