// Patches to rows of ray hits.
#include "rows.h"

#include "parallel.h"

#include <algorithm>
#include <atomic>
#include <bit>
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

namespace {

// Points of the unit square for the sixteen rays of a packet: directions and origins.
struct RowSamples {
  float direction_x[kPacketSize], direction_y[kPacketSize], origin_x[kPacketSize], origin_y[kPacketSize];
};

void make_row_samples(RowSamples& samples, uint64_t row_key, RowGrid grid, uint32_t packet) {
  const uint32_t tile_columns = grid.columns / 4;
  const uint32_t column = 4 * (packet % tile_columns), row = 4 * (packet / tile_columns);
  const uint32_t shift_u = static_cast<uint32_t>(row_key) % grid.rows;
  const uint32_t shift_v = static_cast<uint32_t>(row_key >> 32) % grid.columns;
  const float scale_x = 1 / static_cast<float>(grid.columns), scale_y = 1 / static_cast<float>(grid.rows);
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t a = column + k % 4, b = row + k / 4, index = b * grid.columns + a;
    const Vec2 d = make_jitter(row_key, 2 * index), o = make_jitter(row_key, 2 * index + 1);
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

// The row of a receiver of many patches: every ray starts on one of them and leaves by its normal.
void make_shared_packet(HitPacket& rays, const ReceiverTable& receivers, uint32_t receiver,
                        const PatchTable& patches, const FaceTable& faces, const FaceFrameTable& frames,
                        uint64_t row_key, RowGrid grid, uint32_t packet) {
  RowSamples samples;
  make_row_samples(samples, row_key, grid, packet);
  RayPacket& ray = rays.ray;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Origin origin =
        find_origin(receivers, receiver, patches, faces, frames, {samples.origin_x[k], samples.origin_y[k]});
    const Frame frame = make_frame(origin.normal);
    const Vec3 local = make_local_direction(samples.direction_x[k], samples.direction_y[k]);
    const Vec3 direction = local.x * frame.tangent + local.y * frame.bitangent + local.z * frame.normal;
    const Vec3 point = origin.point + ray_offset(origin.point) * origin.normal;
    ray.origin_x[k] = point.x, ray.origin_y[k] = point.y, ray.origin_z[k] = point.z;
    ray.direction_x[k] = direction.x, ray.direction_y[k] = direction.y, ray.direction_z[k] = direction.z;
    ray.near_distance[k] = 0, ray.far_distance[k] = std::numeric_limits<float>::infinity();
  }
}

}  // namespace

void make_row_packet(HitPacket& rays, const FaceFrameTable& frames, const Frame& frame, uint32_t face,
                     uint32_t cell, uint32_t level, uint64_t row_key, RowGrid grid, uint32_t packet) {
  const bool triangle = frames.triangle[face];
  const CellFrame place = make_cell_frame(triangle, cell, level);
  // Loops over lanes stand alone, so that they compile to wide instructions: hashing, directions, origins.
  RowSamples samples;
  make_row_samples(samples, row_key, grid, packet);
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
    const Vec3 local = make_local_direction(samples.direction_x[k], samples.direction_y[k]);
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

Origin find_origin(const ReceiverTable& receivers, uint32_t receiver, const PatchTable& patches,
                   const FaceTable& faces, const FaceFrameTable& frames, Vec2 sample) {
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
  return {face_point(frames, face, cell_sample(triangle, cell, inside)), faces.normal[face]};
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

namespace {

struct RowCounts {
  uint32_t nothing = 0, back = 0, buried = 0;
};

// Where the rays of one receiver end; patch and cell: grid.ray_count() entries each, overwritten.
RowCounts cast_row(std::span<uint32_t> patch, std::span<uint32_t> cell, const LeafIndex& index,
                   const ReceiverTable& receivers, size_t receiver, const PatchTable& patches,
                   const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer, RowGrid grid,
                   uint64_t seed) {
  const bool shared = receivers.first[receiver + 1] - receivers.first[receiver] > 1;
  const uint32_t own = receivers.patch[receivers.first[receiver]], face = patches.face[own];
  const Frame frame = make_frame(receivers.normal[receiver]);
  const uint64_t key = make_row_key(seed, face, patches.cell[own], patches.level[own], kRowHits);
  RowCounts counts;
  HitPacket packet;
  for (uint32_t tile = 0; tile < grid.packet_count(); ++tile) {
    if (shared)
      make_shared_packet(packet, receivers, static_cast<uint32_t>(receiver), patches, faces, frames, key,
                         grid, tile);
    else
      make_row_packet(packet, frames, frame, face, patches.cell[own], patches.level[own], key, grid, tile);
    find_hits(tracer, packet, 0xffff);
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
    const uint32_t buried = find_buried(tracer, faces, frame, packet.ray, back);
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (buried >> k & 1u) patch[first + k] = kHitBuried;
    counts.buried += static_cast<uint32_t>(std::popcount(buried));
    counts.back += static_cast<uint32_t>(std::popcount(back & ~buried));
  }
  return counts;
}

}  // namespace

uint64_t cast_rows(HitTable& hits, PatchTable& patches, std::span<const uint32_t> which,
                   const LeafIndex& index, const ReceiverTable& receivers, const FaceTable& faces,
                   const FaceFrameTable& frames, const Tracer& tracer, const RowSettings& settings) {
  const RowGrid grid = make_row_grid(settings.rays);
  hits.ray_count = grid.ray_count();
  for (std::vector<uint32_t>* column : {&hits.nothing, &hits.back, &hits.buried})
    column->resize(receivers.size());
  hits.patch.resize(settings.keep ? receivers.size() * hits.ray_count : 0);
  hits.cell.resize(hits.patch.size());
  for_rows(which.size(), 16, [&](size_t begin, size_t end) {
    RowScratch scratch;
    if (!settings.keep) scratch.patch.resize(hits.ray_count), scratch.cell.resize(hits.ray_count);
    for (size_t k = begin; k < end; ++k) {
      const size_t row = which[k], first = row * hits.ray_count;
      const auto [nothing, back, buried] =
          settings.keep ? cast_row(std::span(hits.patch).subspan(first, hits.ray_count),
                                   std::span(hits.cell).subspan(first, hits.ray_count), index, receivers, row,
                                   patches, faces, frames, tracer, grid, settings.seed)
                        : cast_row(scratch.patch, scratch.cell, index, receivers, row, patches, faces, frames,
                                   tracer, grid, settings.seed);
      hits.nothing[row] = nothing, hits.back[row] = back, hits.buried[row] = buried;
      const float exposed = 1 - static_cast<float>(buried) / static_cast<float>(hits.ray_count);
      for (uint32_t m = receivers.first[row]; m < receivers.first[row + 1]; ++m)
        patches.exposed[receivers.patch[m]] = exposed;
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

RowHits find_row(RowScratch& scratch, const Rows& rows, size_t receiver) {
  const uint32_t ray_count = rows.hits.ray_count;
  if (!rows.hits.patch.empty()) {
    const size_t first = receiver * ray_count;
    return {std::span(rows.hits.patch).subspan(first, ray_count),
            std::span(rows.hits.cell).subspan(first, ray_count)};
  }
  scratch.patch.resize(ray_count), scratch.cell.resize(ray_count);
  cast_row(scratch.patch, scratch.cell, rows.index, rows.receivers, receiver, rows.patches, rows.faces,
           rows.frames, rows.tracer, rows.grid, rows.seed);
  return {scratch.patch, scratch.cell};
}

}  // namespace patchlight
