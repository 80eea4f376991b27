// Patches to rows of ray hits.
#include "engine/transport/rows.h"

#include "engine/base/parallel.h"
#include "engine/mesh/buried.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace patchlight {
namespace {

// The row of a receiver of many patches: every ray starts on one of them and leaves by its normal.
void make_shared_packet(HitPacket& rays, const Casters& from, uint32_t receiver, uint64_t key,
                        uint32_t packet) {
  RaySamples samples;
  make_ray_samples(samples, key, from.grid, packet);
  RayPacket& ray = rays.ray;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Origin origin = find_origin(from, receiver, {samples.origin_x[k], samples.origin_y[k]});
    const Frame frame = make_frame(origin.normal);
    const Vec3 local = make_cosine_direction(samples.direction_x[k], samples.direction_y[k]);
    const Vec3 direction = local.x * frame.tangent + local.y * frame.bitangent + local.z * frame.normal;
    const Vec3 point = origin.point + ray_offset(origin.point) * origin.normal;
    ray.origin_x[k] = point.x, ray.origin_y[k] = point.y, ray.origin_z[k] = point.z;
    ray.direction_x[k] = direction.x, ray.direction_y[k] = direction.y, ray.direction_z[k] = direction.z;
    ray.near_distance[k] = 0, ray.far_distance[k] = std::numeric_limits<float>::infinity();
  }
}

struct RowCounts {
  uint32_t nothing = 0, back = 0, buried = 0;
};

// Where the rays of one receiver end; patch and cell: grid.ray_count() entries each, overwritten.
RowCounts cast_row(std::span<uint32_t> patch, std::span<uint32_t> cell, const Casters& from,
                   uint32_t receiver) {
  const auto& [surfaces, patches, index, receivers, grid, seed] = from;
  const FaceTable& faces = surfaces.faces;
  const FaceFrameTable& frames = surfaces.frames;
  const bool shared = receivers.first[receiver + 1] - receivers.first[receiver] > 1;
  CellRays rays = make_cell_rays(faces, name_cell(patches, receivers.patch[receivers.first[receiver]]),
                                 kRowRays, seed, grid);
  rays.frame = make_frame(receivers.normal[receiver]);
  RowCounts counts;
  HitPacket packet;
  for (uint32_t tile = 0; tile < grid.packet_count(); ++tile) {
    if (shared)
      make_shared_packet(packet, from, receiver, rays.key, tile);
    else
      make_ray_packet(packet, rays, frames, tile);
    find_hits(surfaces.tracer, packet, 0xffff);
    const size_t first = tile * kPacketSize;
    uint32_t back = 0;
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const uint32_t seen = packet.face[k];
      patch[first + k] = kHitNothing;
      cell[first + k] = 0;
      if (seen == kNone) {
        ++counts.nothing;
        continue;
      }
      const RayPacket& r = packet.ray;
      const Vec3 direction(r.direction_x[k], r.direction_y[k], r.direction_z[k]);
      if (dot(direction, faces.normal[seen]) >= 0) {
        patch[first + k] = kHitBack;
        back |= 1u << k;
        continue;
      }
      const Vec3 point = Vec3(r.origin_x[k], r.origin_y[k], r.origin_z[k]) + r.far_distance[k] * direction;
      cell[first + k] = find_cell(frames.triangle[seen], find_face_parameters(frames, seen, point));
      patch[first + k] = find_leaf(patches, index, seen, cell[first + k]);
    }
    if (!back) continue;
    const uint32_t buried = find_buried(surfaces, rays.frame, packet.ray, back);
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (buried >> k & 1u) patch[first + k] = kHitBuried;
    counts.buried += static_cast<uint32_t>(std::popcount(buried));
    counts.back += static_cast<uint32_t>(std::popcount(back & ~buried));
  }
  return counts;
}

}  // namespace

Origin find_origin(const Casters& from, uint32_t receiver, Vec2 sample) {
  const ReceiverTable& receivers = from.receivers;
  const PatchTable& patches = from.patches;
  const FaceFrameTable& frames = from.surfaces.frames;
  const uint32_t first = receivers.first[receiver], last = receivers.first[receiver + 1];
  // The first coordinate picks the patch by its area; what is left of it is uniform again.
  const float* until = receivers.area_until.data();
  const auto entry = std::min(
      static_cast<uint32_t>(std::upper_bound(until + first, until + last, sample.x) - until), last - 1);
  const float before = entry > first ? until[entry - 1] : 0;
  const float rest = (sample.x - before) / std::max(until[entry] - before, 1e-30f);
  const uint32_t patch = receivers.patch[entry], face = patches.face[patch];
  const bool triangle = frames.triangle[face];
  const CellFrame cell = make_cell_frame(triangle, patches.cell[patch], patches.level[patch]);
  const Vec2 inside(std::clamp(rest, 0.0f, 0x1.fffffep-1f), sample.y);
  return {face_point(frames, face, cell_sample(triangle, cell, inside)), from.surfaces.faces.normal[face]};
}

uint64_t cast_rows(HitTable& hits, std::span<float> exposed, std::span<const uint32_t> which,
                   const Casters& from, bool keep) {
  const ReceiverTable& receivers = from.receivers;
  hits.ray_count = from.grid.ray_count();
  for (std::vector<uint32_t>* column : {&hits.nothing, &hits.back, &hits.buried})
    column->resize(receivers.size());
  hits.patch.resize(keep ? receivers.size() * hits.ray_count : 0);
  hits.cell.resize(hits.patch.size());
  for_rows(which.size(), 16, [&](size_t begin, size_t end) {
    RowScratch scratch;
    if (!keep) scratch.patch.resize(hits.ray_count), scratch.cell.resize(hits.ray_count);
    for (size_t k = begin; k < end; ++k) {
      const uint32_t row = which[k];
      const size_t first = size_t{row} * hits.ray_count;
      const auto [nothing, back, buried] =
          keep ? cast_row(std::span(hits.patch).subspan(first, hits.ray_count),
                          std::span(hits.cell).subspan(first, hits.ray_count), from, row)
               : cast_row(scratch.patch, scratch.cell, from, row);
      hits.nothing[row] = nothing, hits.back[row] = back, hits.buried[row] = buried;
      const float share = 1 - static_cast<float>(buried) / static_cast<float>(hits.ray_count);
      for (uint32_t m = receivers.first[row]; m < receivers.first[row + 1]; ++m)
        exposed[receivers.patch[m]] = share;
    }
  });
  return uint64_t{hits.ray_count} * which.size();
}

void move_rows(HitTable& hits, std::span<const uint32_t> row_before, const PatchTable& before,
               std::span<const uint32_t> parent) {
  std::vector<uint32_t> patch_first(before.size() + 1, 0);  // CSR: patch before -> patches now
  for (const uint32_t patch : parent) ++patch_first[patch + 1];
  std::partial_sum(patch_first.begin(), patch_first.end(), patch_first.begin());
  const HitTable old = std::move(hits);
  const size_t ray_count = old.ray_count, count = row_before.size();
  hits = {};
  hits.ray_count = old.ray_count;
  for (std::vector<uint32_t>* column : {&hits.nothing, &hits.back, &hits.buried}) column->assign(count, 0);
  hits.patch.resize(old.patch.empty() ? 0 : count * ray_count);
  hits.cell.resize(hits.patch.size());
  for_rows(count, 64, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const size_t from = row_before[row];
      if (from == kNone) continue;
      hits.nothing[row] = old.nothing[from], hits.back[row] = old.back[from];
      hits.buried[row] = old.buried[from];
      if (old.patch.empty()) continue;
      for (size_t k = 0; k < ray_count; ++k) {
        const uint32_t hit = old.patch[from * ray_count + k], cell = old.cell[from * ray_count + k];
        uint32_t& patch = hits.patch[row * ray_count + k];
        hits.cell[row * ray_count + k] = cell;
        patch = hit;
        if (hit >= kHitBuried) continue;
        patch = patch_first[hit];
        if (patch_first[hit + 1] - patch > 1) patch += cell_child(cell, before.level[hit] + 1);
      }
    }
  });
}

RowHits find_row(RowScratch& scratch, const Rows& rows, uint32_t receiver) {
  const uint32_t ray_count = rows.hits.ray_count;
  if (!rows.hits.patch.empty()) {
    const size_t first = size_t{receiver} * ray_count;
    return {std::span(rows.hits.patch).subspan(first, ray_count),
            std::span(rows.hits.cell).subspan(first, ray_count)};
  }
  scratch.patch.resize(ray_count), scratch.cell.resize(ray_count);
  cast_row(scratch.patch, scratch.cell, rows.by, receiver);
  return {scratch.patch, scratch.cell};
}

}  // namespace patchlight
