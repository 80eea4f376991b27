// A shooter and elements to irradiance. Where a shot is bright it is looked at as closely as direct light.
// Where it is one of thousands that are dim, an element casts a single ray, sixteen elements a packet: shots
// start and end elsewhere each time, so that their errors average out.
#include "engine/light/shoot.h"

#include "engine/base/parallel.h"
#include "engine/base/sampling.h"

#include <algorithm>
#include <atomic>

namespace patchlight {
namespace {

// Dim elements that wait for their packet to be full.
struct DimPacket {
  RayPacket rays;
  std::array<uint32_t, kPacketSize> row;
  std::array<float, kPacketSize> factor;
  uint32_t count = 0;
};

// A pair of points, one on each.
void add_dim_ray(DimPacket& dim, const ElementPoints& from, float factor, const Emitter& shooter) {
  const PatchTable& elements = from.elements;
  const FaceFrameTable& frames = from.surfaces.frames;
  const uint64_t key = mix_bits(from.key);
  const uint32_t row = from.row;
  const uint32_t face = elements.face[row], k = dim.count++;
  const bool triangle = frames.triangle[face], shooter_triangle = frames.triangle[shooter.face];
  const CellFrame cell = make_cell_frame(triangle, elements.cell[row], elements.level[row]);
  const Vec3 near = face_point(frames, face, cell_sample(triangle, cell, make_jitter(key, 0)));
  const Vec3 far =
      face_point(frames, shooter.face, cell_sample(shooter_triangle, shooter.cell, make_jitter(key, 1)));
  const Vec3 start = near + ray_offset(near) * from.surfaces.faces.normal[face];
  const Vec3 way = far + ray_offset(near, far) * shooter.normal - start;
  dim.rays.origin_x[k] = start.x, dim.rays.origin_y[k] = start.y, dim.rays.origin_z[k] = start.z;
  dim.rays.direction_x[k] = way.x, dim.rays.direction_y[k] = way.y, dim.rays.direction_z[k] = way.z;
  dim.rays.near_distance[k] = 0, dim.rays.far_distance[k] = 1;
  dim.row[k] = row, dim.factor[k] = factor;
}

void finish_dim(std::span<Rgb> irradiance, DimPacket& dim, Rgb sent, const Tracer& tracer) {
  if (dim.count == 0) return;
  const uint32_t blocked = find_blocked(tracer, dim.rays, (1u << dim.count) - 1);
  for (uint32_t k = 0; k < dim.count; ++k)
    if (!(blocked >> k & 1u)) irradiance[dim.row[k]] = dim.factor[k] * sent;
  dim.count = 0;
}

}  // namespace

ShotCounts shoot(std::span<Rgb> irradiance, const Shot& shot, const PatchTable& elements,
                 const Surfaces& surfaces, ShotRays rays) {
  const Emitter& shooter = shot.shooter;
  const Rgb sent = shot.sent;
  const uint32_t packet_count = std::clamp(rays.mixed / kPacketSize, 1u, kPacketsMax);
  const uint64_t shot_key = mix_bits(shot.number + 1);
  std::atomic<uint64_t> factor_count{0}, ray_count{0};
  for_rows(elements.size(), 1024, [&](size_t begin, size_t end) {
    ElementPoints from(surfaces, elements, packet_count);
    DimPacket dim;
    uint64_t counted = 0, cast = 0;
    for (auto row = static_cast<uint32_t>(begin); row < end; ++row) {
      irradiance[row] = Rgb(0);
      if (elements.exposed[row] == 0) continue;
      start_element(from, row, shot.seed, shot_key);
      if (!can_reach(from.corners, from.normal, shooter)) continue;
      const bool partly_buried = elements.exposed[row] < 1;
      if (partly_buried) {
        make_packets(from, 1);
        if (from.open[0] == 0) continue;
      }
      const float factor = find_mean_factor(from, shooter, partly_buried ? from.open[0] : 0xffff);
      if (factor == 0) continue;
      ++counted;
      if (!partly_buried && factor * largest(sent) < rays.bright) {
        add_dim_ray(dim, from, factor, shooter);
        ++cast;
        if (dim.count == kPacketSize) finish_dim(irradiance, dim, sent, surfaces.tracer);
        continue;
      }
      const VisibilitySums sums = find_visibility(from, shooter, packet_count, rays.unmixed);
      cast += sums.rays;
      irradiance[row] = factor * sums.share() * sent;
    }
    finish_dim(irradiance, dim, sent, surfaces.tracer);
    factor_count += counted, ray_count += cast;
  });
  return {factor_count, ray_count};
}

}  // namespace patchlight
