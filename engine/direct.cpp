// Elements and lamps to direct irradiance.
//
// Per lamp: the exact unoccluded factor, times sum(k V) / sum(k) over pairs of points, k the form-factor
// kernel and V their visibility. A plain visible share instead is biased for near and large pairs. (Ratio
// estimators in rendering: Heitz, Hill, McGuire: Combining Analytic Direct Illumination and Stochastic
// Shadows, 2018.)
#include "direct.h"

#include "aims.h"
#include "lamps.h"
#include "parallel.h"
#include "rows.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>

namespace patchlight {
namespace {

// An element nearer to a lamp than this many of its edges takes its mean factor by Gauss's rule, not at its
// centre.
constexpr float kNearLamp = 40;
// A lamp that gives less than this share of an element's light, blockers aside, gets no more than one packet.
constexpr double kWeakLamp = 0.06;
constexpr uint32_t kPacketsMax = 16;  // of pairs for an element and a lamp

// Sixteen points just off an element: a stratum of 4 x 4 each. A packet's samples keep to one of 2 x 2 parts
// of their strata, later packets to finer parts, so that the union of 4 or 16 packets is stratified 8 x 8 or
// 16 x 16.
struct Points {
  float x[kPacketSize], y[kPacketSize], z[kPacketSize];
};

// Which part of a stratum the samples of a packet keep to, by the packet's number.
struct Strata {
  std::array<Vec2, kPacketsMax> base;
  float size = 1;
  explicit Strata(uint32_t packets) : base{} {
    // From the last digit of the packet to the first: each halves what the ones before it left.
    for (uint32_t parts = packets, shift = 0; parts >= 4; parts /= 4, shift += 2) {
      size *= 0.5f;
      for (uint32_t k = 0; k < kPacketsMax; ++k)
        base[k] += size * Vec2(static_cast<float>(k >> shift & 1u), static_cast<float>(k >> shift >> 1 & 1u));
    }
  }
};

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

uint64_t element_key(const PatchTable& elements, uint32_t row, uint64_t seed) {
  return make_row_key(seed, elements.face[row], elements.cell[row], elements.level[row], kRowDirect);
}

struct VisibilitySums {
  float all = 0, seen = 0;         // of the kernel
  uint32_t rays = 0, reached = 0;  // counts
};

// Adds one packet of pairs: the element's points against points of the lamp.
void add_visibility(VisibilitySums& sums, const Points& points, uint32_t usable, Vec3 normal,
                    const Lamp& lamp, const FaceFrameTable& frames, const Tracer& tracer, uint64_t key,
                    uint32_t packet, const Strata& strata) {
  const CellFrame whole{Vec2(0), 1};
  const bool triangle = frames.triangle[lamp.face];
  // Strata of the lamp are those of the element with the axes swapped and shuffled: each axis of the one
  // meets each axis of the other evenly.
  const uint64_t lamp_key = mix_bits(key ^ (uint64_t{lamp.face} + 1) * 0x9e3779b97f4a7c15ull);
  const auto shuffle = static_cast<uint32_t>(lamp_key >> 4 * (packet % 15));
  float u[kPacketSize], v[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t column = (k / 4) ^ (shuffle & 3), row = (k % 4) ^ (shuffle >> 2 & 3);
    const Vec2 uv = cell_sample(triangle, whole, stratified_sample(lamp_key, packet, strata, column, row, k));
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

// The packets of points of one element, made when first asked for and used for all lamps; open: which are not
// buried.
struct PointPackets {
  std::array<Points, kPacketsMax> points;
  std::array<uint32_t, kPacketsMax> open;
  uint32_t made = 0;
};

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

// About how far a point is from the nearest of the lamp.
float find_gap(Vec3 point, const Lamp& lamp, const FaceFrameTable& frames) {
  Vec2 uv = clamp(find_face_parameters(frames, lamp.face, point), Vec2(0), Vec2(1));
  if (frames.triangle[lamp.face] && uv.x + uv.y > 1) uv /= uv.x + uv.y;
  return distance(point, face_point(frames, lamp.face, uv));
}

// The element's mean unoccluded factor: at its centre, by Gauss's rule if the lamp is near, at its exposed
// points if part of it is buried (`usable`: which of `points` are not).
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

}  // namespace

uint64_t find_exposed(PatchTable& elements, std::span<const uint32_t> rows,
                      std::span<const uint32_t> element_patch, const PatchTable& patches,
                      const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer,
                      uint64_t seed) {
  std::atomic<uint64_t> ray_count{0};
  for_rows(rows.size(), 256, [&](size_t begin, size_t end) {
    Points points;
    const Strata whole(1);
    for (size_t k = begin; k < end; ++k) {
      const uint32_t row = rows[k];
      const float share = patches.exposed[element_patch[row]];
      elements.exposed[row] = share;
      if (share == 0 || share == 1) continue;
      make_points(points, faces, frames, elements, row, element_key(elements, row, seed), 0, whole);
      const uint32_t buried = find_buried_points(points, faces.normal[elements.face[row]], faces, tracer);
      elements.exposed[row] = 1 - static_cast<float>(std::popcount(buried)) / kPacketSize;
      ray_count += kPacketSize;
    }
  });
  return ray_count;
}

uint64_t find_direct(DirectColumns out, std::span<const uint32_t> rows, const PatchTable& elements,
                     const AimTable& aims, const FaceTable& faces, const FaceFrameTable& frames,
                     const Tracer& tracer, DirectRays rays, uint64_t seed) {
  assert(out.irradiance.size() == elements.size());
  const std::vector<Lamp> lamps = make_lamps(faces, frames);
  std::vector<uint32_t> lamp_of(faces.size(), kNone);
  for (uint32_t k = 0; k < lamps.size(); ++k) lamp_of[lamps[k].face] = k;
  const uint32_t packet_count = std::clamp((rays.mixed + kPacketSize / 2) / kPacketSize, 1u, kPacketsMax);
  const Strata strata(packet_count);
  std::atomic<uint64_t> ray_count{0};
  for_rows(rows.size(), 64, [&](size_t begin, size_t end) {
    PointPackets packets;
    std::array<float, kAimedLampsMax> factor;
    uint64_t cast = 0;
    for (size_t r = begin; r < end; ++r) {
      const uint32_t row = rows[r], list = aims.list_of[faces.polygon[elements.face[row]]];
      const uint32_t first = aims.list_first[list], count = aims.list_first[list + 1] - first;
      const Vec3 normal = faces.normal[elements.face[row]];
      const uint64_t key = element_key(elements, row, seed);
      const uint64_t settled = out.views.settled[row], settled_seen = settled & out.views.seen[row];
      uint64_t seen = settled_seen, hidden = settled & out.views.hidden[row];
      Rgb irradiance(0);
      double variance = 0;  // emissions may be as large as 1e20
      packets.made = 0;
      make_packets(packets, 1, strata, elements, faces, frames, tracer, row, key);
      const bool dark = elements.exposed[row] == 0 || packets.open[0] == 0;
      const auto corners = cell_corners(frames, elements.face[row], elements.cell[row], elements.level[row]);
      // What each lamp would give if nothing were in its way, and all of them together.
      double unoccluded = 0;
      for (uint32_t k = 0; k < count && !dark; ++k) {
        const Lamp& lamp = lamps[lamp_of[aims.lamp[first + k]]];
        factor[k] = 0;
        if (hidden >> k & 1u) continue;
        if (!can_reach(corners, normal, lamp))
          hidden |= uint64_t{1} << k;
        else
          factor[k] = find_mean_factor(elements, frames, row, normal, corners, lamp, packets.points[0],
                                       packets.open[0]);
        unoccluded += factor[k] * luminance(faces.emission[lamp.face]);
      }
      for (uint32_t k = 0; k < count && !dark; ++k) {
        if (factor[k] == 0) continue;  // hidden, or the lamp's horizon crosses a part of the element
        const Lamp& lamp = lamps[lamp_of[aims.lamp[first + k]]];
        const Rgb emission = faces.emission[lamp.face];
        if (settled_seen >> k & 1u) {
          irradiance += factor[k] * emission;
          continue;
        }
        // Packets until enough rays agree (there is no shadow edge here then), or all if they do not; one for
        // a lamp that is weak among many.
        const double strength = factor[k] * luminance(emission);
        const uint32_t most = strength < kWeakLamp * unoccluded ? 1 : packet_count;
        VisibilitySums sums;
        for (uint32_t packet = 0; packet < most; ++packet) {
          if (packet >= rays.unmixed / kPacketSize && (sums.reached == 0 || sums.reached == sums.rays)) break;
          make_packets(packets, packet + 1, strata, elements, faces, frames, tracer, row, key);
          add_visibility(sums, packets.points[packet], packets.open[packet], normal, lamp, frames, tracer,
                         key, packet, strata);
        }
        cast += sums.rays;
        const float visible = sums.all > 0 ? sums.seen / sums.all : 0;
        if (sums.reached == sums.rays) seen |= uint64_t{1} << k;
        if (sums.reached == 0) hidden |= uint64_t{1} << k;
        irradiance += factor[k] * visible * emission;
        // Stratification makes N pairs worth about 3 N random ones (measured on half screens).
        variance += strength * strength * visible * (1 - visible) / (3.0 * std::max(sums.rays, 1u));
      }
      out.irradiance[row] = irradiance;
      out.error[row] = static_cast<float>(std::sqrt(variance));
      out.views.seen[row] = seen;
      out.views.hidden[row] = hidden;
    }
    ray_count += cast;
  });
  return ray_count;
}

uint64_t find_settled(const LampViewTable& views, const PatchTable& elements, const FaceFrameTable& frames,
                      const FaceLinkTable& links, uint32_t row) {
  uint64_t agreed = views.seen[row] | views.hidden[row];
  for (uint32_t edge = 0; edge < edge_count(frames, elements.face[row]); ++edge)
    for (const uint32_t other : find_neighbours(elements, frames, links, row, edge))
      if (other != kNone)
        agreed &= (views.seen[row] & views.seen[other]) | (views.hidden[row] & views.hidden[other]);
  return agreed;
}

}  // namespace patchlight
