// Pairs of points of an element and a lamp; Lambert's formula averaged over an element.
#include "sight.h"

#include "rows.h"

#include <algorithm>
#include <bit>
#include <span>

namespace patchlight {
namespace {

// An element nearer to a lamp than this many of its edges takes its mean factor by Gauss's rule, not at its
// centre.
constexpr float kNearLamp = 40;

Vec2 stratified_sample(uint64_t key, uint32_t packet, const Strata& strata, uint32_t column, uint32_t row,
                       uint32_t index) {
  const Vec2 inside = make_jitter(key, packet * kPacketSize + index);
  const uint32_t part = packet ^ static_cast<uint32_t>(key >> (4 * (index % 8)) & 15);
  return (Vec2(static_cast<float>(column), static_cast<float>(row)) + strata.base[part] +
          strata.size * inside) *
         0.25f;
}

// Parameters of a face to points of it, `offset` lengths off it. Loops over lanes stand alone, so that they
// compile to wide instructions.
void make_face_points(Points& points, const FaceFrameTable& frames, uint32_t face, Vec3 offset,
                      const float (&u)[kPacketSize], const float (&v)[kPacketSize]) {
  const Vec3 origin = frames.origin[face] + offset, edge_u = frames.edge_u[face],
             edge_v = frames.edge_v[face], twist = frames.twist[face];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float both = u[k] * v[k];
    points.x[k] = origin.x + u[k] * edge_u.x + v[k] * edge_v.x + both * twist.x;
    points.y[k] = origin.y + u[k] * edge_u.y + v[k] * edge_v.y + both * twist.y;
    points.z[k] = origin.z + u[k] * edge_u.z + v[k] * edge_v.z + both * twist.z;
  }
}

// About how far a point is from the nearest of the lamp.
float find_gap(Vec3 point, const Lamp& lamp, const FaceFrameTable& frames) {
  const Vec2 in_cell = (find_face_parameters(frames, lamp.face, point) - lamp.cell.origin) / lamp.cell.size;
  Vec2 uv = clamp(in_cell, Vec2(0), Vec2(1));
  if (frames.triangle[lamp.face] && uv.x + uv.y > 1) uv /= uv.x + uv.y;
  return distance(point, face_point(frames, lamp.face, lamp.cell.origin + lamp.cell.size * uv));
}

// Adds one packet of pairs: the element's points against points of the lamp. usable: which of them, a bit a
// point.
void add_visibility(VisibilitySums& sums, const Points& points, uint32_t usable, Vec3 normal,
                    const Lamp& lamp, const FaceFrameTable& frames, const Tracer& tracer, uint64_t key,
                    uint32_t packet, const Strata& strata) {
  const bool triangle = frames.triangle[lamp.face];
  // Strata of the lamp are those of the element with the axes swapped and shuffled: each axis of the one
  // meets each axis of the other evenly.
  const uint64_t lamp_key = mix_bits(key ^ lamp.key);
  const auto shuffle = static_cast<uint32_t>(lamp_key >> 4 * (packet % 15));
  float u[kPacketSize], v[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t column = (k / 4) ^ (shuffle & 3), row = (k % 4) ^ (shuffle >> 2 & 3);
    const Vec2 uv =
        cell_sample(triangle, lamp.cell, stratified_sample(lamp_key, packet, strata, column, row, k));
    u[k] = uv.x, v[k] = uv.y;
  }
  Points targets;
  make_face_points(targets, frames, lamp.face, ray_offset(lamp.centre) * lamp.normal, u, v);
  RayPacket rays;
  float kernel[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float x = targets.x[k] - points.x[k], y = targets.y[k] - points.y[k],
                z = targets.z[k] - points.z[k];
    const float squared = x * x + y * y + z * z;
    const float jacobian = 1 + v[k] * lamp.twist.x + u[k] * lamp.twist.y;
    const float cosine = std::max(x * normal.x + y * normal.y + z * normal.z, 0.0f);
    const float lamp_cosine = std::max(-(x * lamp.normal.x + y * lamp.normal.y + z * lamp.normal.z), 0.0f);
    kernel[k] = cosine * lamp_cosine * jacobian / std::max(squared * squared, 1e-30f);
    rays.origin_x[k] = points.x[k], rays.origin_y[k] = points.y[k], rays.origin_z[k] = points.z[k];
    rays.direction_x[k] = x, rays.direction_y[k] = y, rays.direction_z[k] = z;
    rays.near_distance[k] = 0, rays.far_distance[k] = 1;
  }
  uint32_t active = 0;
  for (uint32_t k = 0; k < kPacketSize; ++k) active |= (kernel[k] > 0 ? 1u : 0u) << k;
  active &= usable;
  if (!active) return;
  const uint32_t blocked = find_blocked(tracer, rays, active);
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    if (!(active >> k & 1u)) continue;
    sums.all += kernel[k];
    if (!(blocked >> k & 1u)) sums.seen += kernel[k];
  }
  sums.rays += static_cast<uint32_t>(std::popcount(active));
  sums.reached += static_cast<uint32_t>(std::popcount(active & ~blocked));
}

}  // namespace

uint64_t make_element_key(const PatchTable& elements, uint32_t row, uint64_t seed) {
  return make_row_key(seed, elements.face[row], elements.cell[row], elements.level[row], kRowDirect);
}

void make_points(Points& points, const FaceTable& faces, const FaceFrameTable& frames,
                 const PatchTable& elements, uint32_t row, uint64_t key, uint32_t packet,
                 const Strata& strata) {
  const uint32_t face = elements.face[row];
  const bool triangle = frames.triangle[face];
  const CellFrame cell = make_cell_frame(triangle, elements.cell[row], elements.level[row]);
  float u[kPacketSize], v[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec2 uv = cell_sample(triangle, cell, stratified_sample(key, packet, strata, k % 4, k / 4, k));
    u[k] = uv.x, v[k] = uv.y;
  }
  const Vec3 normal = faces.normal[face];
  make_face_points(points, frames, face, ray_offset(face_point(frames, face, {u[0], v[0]})) * normal, u, v);
}

uint32_t find_buried_points(const Points& points, Vec3 normal, const FaceTable& faces, const Tracer& tracer) {
  RayPacket rays;
  std::copy_n(points.x, kPacketSize, rays.origin_x);
  std::copy_n(points.y, kPacketSize, rays.origin_y);
  std::copy_n(points.z, kPacketSize, rays.origin_z);
  return find_buried(tracer, faces, make_frame(normal), rays, 0xffff);
}

void make_packets(PointPackets& packets, uint32_t count, const Strata& strata, const PatchTable& elements,
                  const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer, uint32_t row,
                  uint64_t key) {
  for (; packets.made < count; ++packets.made) {
    Points& points = packets.points[packets.made];
    make_points(points, faces, frames, elements, row, key, packets.made, strata);
    packets.open[packets.made] = 0xffff;
    if (elements.exposed[row] < 1)
      packets.open[packets.made] &=
          ~find_buried_points(points, faces.normal[elements.face[row]], faces, tracer);
  }
}

float find_mean_factor(const PatchTable& elements, const FaceFrameTable& frames, uint32_t row, Vec3 normal,
                       const std::array<Vec3, 4>& corners, const Lamp& lamp, const Points& points,
                       uint32_t usable) {
  if (usable != 0xffff) {
    float sum = 0;
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (usable >> k & 1u) sum += find_factor({points.x[k], points.y[k], points.z[k]}, normal, lamp);
    return sum / static_cast<float>(std::popcount(usable));
  }
  const uint32_t face = elements.face[row];
  const Vec3 centre = cell_centre(frames, face, elements.cell[row], elements.level[row]);
  const float edge = longest_edge(corners), gap = find_gap(centre, lamp, frames);
  if (gap > kNearLamp * edge) return find_factor(centre, normal, lamp);
  // Very near, where the factor changes much over the element, parts of it each take the rule.
  const uint32_t parts_level = gap > 3 * edge ? 0 : gap > edge ? 1 : gap > 0.3f * edge ? 2 : 3;
  const uint32_t level = std::min(elements.level[row] + parts_level, kLevelMax);
  // Points of Gauss's rules: four on a square, exact to the third degree; three on a triangle, to the second.
  constexpr float kSixth = 1 / 6.0f, kTwoThirds = 2 / 3.0f;
  constexpr float kSquare[4][2] = {
      {kGauss[0], kGauss[0]}, {kGauss[1], kGauss[0]}, {kGauss[0], kGauss[1]}, {kGauss[1], kGauss[1]}};
  constexpr float kTriangle[3][2] = {{kSixth, kSixth}, {kTwoThirds, kSixth}, {kSixth, kTwoThirds}};
  const bool triangle = frames.triangle[face];
  const uint32_t part_count = 1u << 2 * (level - elements.level[row]);
  float sum = 0;
  for (uint32_t part = 0; part < part_count; ++part) {
    const uint32_t below = level == 0 ? 0 : part << (32 - 2 * level);
    const CellFrame cell = make_cell_frame(triangle, elements.cell[row] | below, level);
    for (const auto& point :
         triangle ? std::span<const float[2]>(kTriangle) : std::span<const float[2]>(kSquare))
      sum += find_factor(face_point(frames, face, cell.origin + cell.size * Vec2(point[0], point[1])), normal,
                         lamp);
  }
  return sum / (static_cast<float>(part_count) * (triangle ? 3.0f : 4.0f));
}

VisibilitySums find_visibility(PointPackets& packets, uint32_t packet_count, uint32_t unmixed,
                               const Strata& strata, const PatchTable& elements, const Lamp& lamp,
                               const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer,
                               uint32_t row, uint64_t key) {
  const Vec3 normal = faces.normal[elements.face[row]];
  VisibilitySums sums;
  for (uint32_t packet = 0; packet < packet_count; ++packet) {
    if (packet >= unmixed / kPacketSize && (sums.reached == 0 || sums.reached == sums.rays)) break;
    make_packets(packets, packet + 1, strata, elements, faces, frames, tracer, row, key);
    add_visibility(sums, packets.points[packet], packets.open[packet], normal, lamp, frames, tracer, key,
                   packet, strata);
  }
  return sums;
}

}  // namespace patchlight
