// Pairs of points of an element and an emitter; Lambert's formula averaged over an element.
#include "engine/light/visibility.h"

#include "engine/base/spherical.h"
#include "engine/mesh/buried.h"
#include "engine/mesh/cell_rays.h"

#include <algorithm>
#include <bit>
#include <span>

namespace patchlight {
namespace {

// An element nearer to an emitter than this many of its edges takes its mean factor by Gauss's rule, not at
// its centre.
constexpr float kNearEmitter = 40;
// A piece nearer than so many of its diameters is near for its size.
constexpr float kNearPiece = 1.5f;
// A piece of a group that looks wider than this takes more than its centre.
constexpr float kWidePiece = 0.1f;

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

// About how far a point is from the nearest of the emitter.
float find_gap(Vec3 point, const Emitter& emitter, const FaceFrameTable& frames) {
  const Vec2 in_cell =
      (find_face_parameters(frames, emitter.face, point) - emitter.cell.origin) / emitter.cell.size;
  Vec2 uv = clamp(in_cell, Vec2(0), Vec2(1));
  if (frames.triangle[emitter.face] && uv.x + uv.y > 1) uv /= uv.x + uv.y;
  return distance(point, face_point(frames, emitter.face, emitter.cell.origin + emitter.cell.size * uv));
}

// Casts one packet of pairs; a kernel of 0 is no pair.
void cast_pairs(VisibilitySums& sums, const ElementPoints& from, uint32_t packet, RayPacket& rays,
                const float (&kernel)[kPacketSize]) {
  const uint32_t active = find_positive(kernel) & from.open[packet];
  ++sums.packets;
  if (!active) return;
  const uint32_t blocked = find_blocked(from.surfaces.tracer, rays, active, RayOrder::kIncoherent);
  const uint32_t seen = active & ~blocked;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t half = find_half(k);
    sums.all[half] += active >> k & 1u ? kernel[k] : 0;
    sums.seen[half] += seen >> k & 1u ? kernel[k] : 0;
  }
  sums.rays += static_cast<uint32_t>(std::popcount(active));
  sums.reached += static_cast<uint32_t>(std::popcount(seen));
}

// Adds one packet of pairs: the element's points against points of the emitter.
void add_visibility(VisibilitySums& sums, const ElementPoints& from, uint32_t packet,
                    const Emitter& emitter) {
  const Points& points = from.points[packet];
  const FaceFrameTable& frames = from.surfaces.frames;
  const Vec3 normal = from.normal;
  const bool triangle = frames.triangle[emitter.face];
  // Strata of the emitter are those of the element with the axes swapped and shuffled: each axis of the one
  // meets each axis of the other evenly.
  const uint64_t emitter_key = mix_bits(from.key ^ emitter.key);
  const auto shuffle = static_cast<uint32_t>(emitter_key >> 4 * (packet % 15));
  float u[kPacketSize], v[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t column = (k / 4) ^ (shuffle & 3), row = (k % 4) ^ (shuffle >> 2 & 3);
    const Vec2 uv = cell_sample(triangle, emitter.cell,
                                stratified_sample(emitter_key, packet, from.strata, column, row, k));
    u[k] = uv.x, v[k] = uv.y;
  }
  Points targets;
  make_face_points(targets, frames, emitter.face,
                   ray_offset({points.x[0], points.y[0], points.z[0]}, emitter.centre) * emitter.normal, u,
                   v);
  RayPacket rays;
  float kernel[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float x = targets.x[k] - points.x[k], y = targets.y[k] - points.y[k],
                z = targets.z[k] - points.z[k];
    const float squared = x * x + y * y + z * z;
    const float jacobian = 1 + v[k] * emitter.twist.x + u[k] * emitter.twist.y;
    const float cosine = std::max(x * normal.x + y * normal.y + z * normal.z, 0.0f);
    const float emitter_cosine =
        std::max(-(x * emitter.normal.x + y * emitter.normal.y + z * emitter.normal.z), 0.0f);
    kernel[k] = cosine * emitter_cosine * jacobian / std::max(squared * squared, 1e-30f);
    rays.origin_x[k] = points.x[k], rays.origin_y[k] = points.y[k], rays.origin_z[k] = points.z[k];
    rays.direction_x[k] = x, rays.direction_y[k] = y, rays.direction_z[k] = z;
    rays.near_distance[k] = 0, rays.far_distance[k] = 1;
  }
  cast_pairs(sums, from, packet, rays, kernel);
}

// The points of a packet, just off the element's face.
void make_points(Points& points, const ElementPoints& from, uint32_t packet) {
  const FaceFrameTable& frames = from.surfaces.frames;
  const auto [face, code, level] = name_cell(from.elements, from.row);
  const bool triangle = frames.triangle[face];
  const CellFrame cell = make_cell_frame(triangle, code, level);
  float u[kPacketSize], v[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec2 uv =
        cell_sample(triangle, cell, stratified_sample(from.key, packet, from.strata, k % 4, k / 4, k));
    u[k] = uv.x, v[k] = uv.y;
  }
  const Vec3 normal = from.surfaces.faces.normal[face];
  make_face_points(points, frames, face, ray_offset(face_point(frames, face, {u[0], v[0]})) * normal, u, v);
}

void start_at(RayPacket& rays, const Points& points) {
  std::copy_n(points.x, kPacketSize, rays.origin_x);
  std::copy_n(points.y, kPacketSize, rays.origin_y);
  std::copy_n(points.z, kPacketSize, rays.origin_z);
}

// Which of the points lie inside a solid: a bit a point.
uint32_t find_buried_points(const Points& points, Vec3 normal, const Surfaces& surfaces) {
  RayPacket rays;
  start_at(rays, points);
  return find_buried(surfaces, make_frame(normal), rays, 0xffff);
}

}  // namespace

void start_element(ElementPoints& from, uint32_t row, uint64_t seed, uint64_t salt) {
  const auto [face, cell, level] = name_cell(from.elements, row);
  from.row = row;
  from.corners = cell_corners(from.surfaces.frames, face, cell, level);
  from.centre = cell_centre(from.surfaces.frames, face, cell, level);
  from.normal = from.surfaces.faces.normal[face];
  from.edge = longest_edge(from.corners);
  from.key = make_ray_key(seed, face, cell, level, kDirectRays) ^ salt;
  from.made = 0;
}

void make_packets(ElementPoints& from, uint32_t count) {
  for (; from.made < count; ++from.made) {
    Points& points = from.points[from.made];
    make_points(points, from, from.made);
    from.open[from.made] = 0xffff;
    if (from.elements.exposed[from.row] < 1)
      from.open[from.made] &= ~find_buried_points(points, from.normal, from.surfaces);
  }
}

float find_mean_factor(const ElementPoints& from, const Emitter& emitter, uint32_t usable) {
  const FaceFrameTable& frames = from.surfaces.frames;
  const Vec3 normal = from.normal;
  const float edge = from.edge;
  if (usable != 0xffff) {
    const Points& points = from.points[0];
    float sum = 0;
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (usable >> k & 1u)
        sum += find_point_factor({points.x[k], points.y[k], points.z[k]}, normal, emitter);
    return sum / static_cast<float>(std::popcount(usable));
  }
  // At least; the nearest point itself takes longer to find.
  float gap = distance(from.centre, emitter.centre) - emitter.diameter;
  if (gap > kNearEmitter * edge) return find_point_factor(from.centre, normal, emitter);
  const auto [face, code, own_level] = name_cell(from.elements, from.row);
  if (gap <= 3 * edge) gap = find_gap(from.centre, emitter, frames);
  // Very near, where the factor changes much over the element, parts of it each take the rule.
  const uint32_t parts_level = gap > 3 * edge ? 0 : gap > edge ? 1 : gap > 0.3f * edge ? 2 : 3;
  const uint32_t level = std::min(own_level + parts_level, kLevelMax);
  // Points of Gauss's rules: four on a square, exact to the third degree; three on a triangle, to the second.
  constexpr float kSixth = 1 / 6.0f, kTwoThirds = 2 / 3.0f;
  constexpr float kSquare[4][2] = {
      {kGauss[0], kGauss[0]}, {kGauss[1], kGauss[0]}, {kGauss[0], kGauss[1]}, {kGauss[1], kGauss[1]}};
  constexpr float kTriangle[3][2] = {{kSixth, kSixth}, {kTwoThirds, kSixth}, {kSixth, kTwoThirds}};
  const bool triangle = frames.triangle[face];
  const uint32_t part_count = 1u << 2 * (level - own_level);
  float sum = 0;
  for (uint32_t part = 0; part < part_count; ++part) {
    const uint32_t below = level == 0 ? 0 : part << (32 - 2 * level);
    const CellFrame cell = make_cell_frame(triangle, code | below, level);
    for (const auto& point :
         triangle ? std::span<const float[2]>(kTriangle) : std::span<const float[2]>(kSquare))
      sum += find_point_factor(face_point(frames, face, cell.origin + cell.size * Vec2(point[0], point[1])),
                               normal, emitter);
  }
  return sum / (static_cast<float>(part_count) * (triangle ? 3.0f : 4.0f));
}

VisibilitySums find_visibility(ElementPoints& from, const Emitter& emitter, uint32_t packet_count,
                               uint32_t unmixed) {
  VisibilitySums sums;
  for (uint32_t packet = 0; packet < packet_count; ++packet) {
    if (packet >= unmixed / kPacketSize && !sums.mixed()) break;
    make_packets(from, packet + 1);
    add_visibility(sums, from, packet, emitter);
  }
  return sums;
}

namespace {

void add_piece(GroupLook& look, uint32_t piece, Rgb irradiance, float strength) {
  look.irradiance += irradiance;
  look.piece[look.count] = static_cast<uint8_t>(piece);
  look.strength_until[look.count++] = look.strength += strength;
}

// Whatever is infinitely far away brings all points of a face the same.
void find_unoccluded_sky(GroupLook& look, ElementPoints& from, const EmitterGroups& groups, uint32_t group,
                         uint64_t pieces) {
  const uint32_t first = groups.sky_first(group);
  find_sky_irradiance(from.sky, groups.sky, from.surfaces.sky, from.normal, first,
                      first + groups.piece_count(group));
  look.irradiance = Rgb(0), look.strength = 0, look.count = 0;
  for (uint64_t rest = pieces; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<uint32_t>(std::countr_zero(rest));
    if (from.sky.strength[first + k] > 0)
      add_piece(look, k, from.sky.irradiance[first + k], from.sky.strength[first + k]);
  }
}

}  // namespace

void find_unoccluded(GroupLook& look, ElementPoints& from, const EmitterGroups& groups, uint32_t group,
                     uint64_t pieces) {
  if (groups.is_sky(group)) return find_unoccluded_sky(look, from, groups, group, pieces);
  const Vec3 centre = from.centre, normal = from.normal;
  const uint32_t face = from.elements.face[from.row];
  const float far = kNearEmitter * from.edge, far_squared = far * far;
  const uint32_t first = groups.piece_first[group], usable = from.open[0];
  std::array<float, kGroupPiecesMax> strength;
  find_strengths(strength, groups, group, centre, normal);
  look.irradiance = Rgb(0), look.strength = 0, look.count = 0;
  for (uint64_t rest = pieces; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<uint32_t>(std::countr_zero(rest));
    const uint32_t piece = first + k;
    const Emitter& emitter = groups.pieces[piece];
    const Rgb emission = groups.emission[piece];
    const Vec3 way = emitter.centre - centre;
    const float squared = dot(way, way), wide = groups.diameter_squared[piece];
    float value = strength[k];
    // The centre tells a piece that is small and far from an element that is small.
    if (usable != 0xffff || wide > kWidePiece * kWidePiece * squared || squared < 4 * far_squared) {
      if (emitter.face == face) continue;
      // Where the centres do not see each other, other points may.
      if (value <= 0 && !can_reach(from.corners, normal, emitter)) continue;
      value = find_mean_factor(from, emitter, usable) * luminance(emission);
    }
    if (value <= 0) continue;
    add_piece(look, k, value / luminance(emission) * emission, value);
  }
}

namespace {

uint64_t make_group_key(const ElementPoints& from, uint32_t group) {
  return mix_bits(from.key ^ (uint64_t{group} + 1) * 0x9e3779b97f4a7c15ull);
}

// A packet's places on pieces of a group.
struct PickedPieces {
  std::array<uint32_t, kPacketSize> piece;  // of the group
  std::array<float, kPacketSize> strength;  // what it was picked by
  std::array<float, kPacketSize> u, v;      // samples of the unit square
};
// Quarters of all strength go with rows of the element's points, quarters of those with columns.
void pick_pieces(PickedPieces& picked, const ElementPoints& from, uint32_t packet, const GroupLook& look,
                 uint64_t key) {
  const auto shuffle = static_cast<uint32_t>(key >> 4 * (packet % 15));
  const uint32_t shift_column = shuffle & 3, shift_row = shuffle >> 2 & 3;
  std::array<float, kPacketSize> at;
  std::array<uint32_t, kPacketSize> entry{};
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec3 inside = make_jitter3(key, packet * kPacketSize + k);
    const uint32_t stratum = 4 * ((k / 4) ^ shift_column) + ((k % 4) ^ shift_row);
    const uint32_t part = packet ^ static_cast<uint32_t>(key >> (4 * (k % 8)) & 15);
    at[k] = (static_cast<float>(stratum) + from.strata.place[part] + from.strata.place_size * inside.x) *
            (look.strength / 16);
    picked.u[k] = inside.y, picked.v[k] = inside.z;
  }
  for (uint32_t n = 0; n + 1 < look.count; ++n) {
    const float until = look.strength_until[n];
    for (uint32_t k = 0; k < kPacketSize; ++k) entry[k] += at[k] >= until ? 1 : 0;
  }
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const uint32_t n = entry[k];
    picked.piece[k] = look.piece[n];
    picked.strength[k] = look.strength_until[n] - (n ? look.strength_until[n - 1] : 0);
  }
}

// Adds one packet of rays from the element's points to cells of the sky, or to the sun, and on for ever.
void add_sky_packet(VisibilitySums& sums, const ElementPoints& from, uint32_t packet, const GroupLook& look,
                    const EmitterGroups& groups, uint32_t group) {
  const Vec3 normal = from.normal;
  const uint64_t key = make_group_key(from, group);
  const uint32_t first = groups.sky_first(group);
  PickedPieces picked;
  pick_pieces(picked, from, packet, look, key);
  // The disc of the sun is one piece: its strata are those of the element, shuffled.
  if (groups.is_sun(group)) {
    const auto shuffle = static_cast<uint32_t>(key >> 4 * (packet % 15));
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const Vec2 sample = stratified_sample(key, packet, from.strata, (k / 4) ^ (shuffle & 3),
                                            (k % 4) ^ (shuffle >> 2 & 3), k);
      picked.u[k] = sample.x, picked.v[k] = sample.y;
    }
  }
  for (uint32_t& piece : picked.piece) piece += first;
  RayPacket rays;
  float sent[kPacketSize], kernel[kPacketSize];
  start_at(rays, from.points[packet]);
  aim_at_sky(rays, sent, groups.sky, from.surfaces.sky, picked.piece, picked.u, picked.v);
  // Over the density, as for lamps; the emission of a piece counts as even.
  for (uint32_t k = 0; k < kPacketSize; ++k)
    kernel[k] = std::max(rays.direction_x[k] * normal.x + rays.direction_y[k] * normal.y +
                             rays.direction_z[k] * normal.z,
                         0.0f) *
                sent[k] / picked.strength[k];
  cast_pairs(sums, from, packet, rays, kernel);
}

bool is_near(const Emitter& piece, Vec3 point) {
  const Vec3 way = piece.centre - point;
  return dot(way, way) < kNearPiece * kNearPiece * piece.diameter * piece.diameter;
}

// Turns ray k to a piece that is near for its size: even in the solid angle that the piece has there, for
// over its area what it sends varies without bound, and few rays would find the nearest of it.
void aim_at_near_piece(RayPacket& rays, float& sent, uint32_t k, const Emitter& piece, float emission,
                       double u, double v) {
  const DVec3 origin(rays.origin_x[k], rays.origin_y[k], rays.origin_z[k]), normal(piece.normal);
  std::array<DVec3, 4> unit;
  for (size_t c = 0; c < piece.corner_count; ++c) {
    unit[c] = DVec3(piece.corners[c]) - origin;
    const double size = length(unit[c]);
    if (!(size > 0)) return;  // stays as it is
    unit[c] /= size;
  }
  const double first = find_solid_angle(unit[0], unit[1], unit[2]);
  const double second = piece.corner_count == 4 ? find_solid_angle(unit[0], unit[2], unit[3]) : 0,
               all = first + second;
  if (!(all > kSmallSolidAngle)) return;
  const bool in_first = u * all < first;
  const double rest = in_first ? u * all / first : (u * all - first) / second;
  const DVec3 way = in_first ? sample_spherical_triangle(unit[0], unit[1], unit[2], first, rest, v)
                             : sample_spherical_triangle(unit[0], unit[2], unit[3], second, rest, v);
  const double slope = dot(way, normal);
  if (!(slope < 0)) {
    sent = 0;
    return;
  }
  const Vec3 target(origin + dot(DVec3(piece.corners[0]) - origin, normal) / slope * way);
  const Vec3 start(origin);
  const Vec3 to = target + ray_offset(start, target) * piece.normal - start;
  const float squared = dot(to, to);
  rays.direction_x[k] = to.x, rays.direction_y[k] = to.y, rays.direction_z[k] = to.z;
  // What the kernel of areas divides by is taken back.
  sent = static_cast<float>(all) * emission * squared * std::sqrt(squared);
}

// Adds one packet of pairs of the element's points and points of the group's pieces.
void add_lamp_packet(VisibilitySums& sums, const ElementPoints& from, uint32_t packet, const GroupLook& look,
                     const EmitterGroups& groups, uint32_t group) {
  const Vec3 normal = from.normal;
  PickedPieces picked;
  pick_pieces(picked, from, packet, look, make_group_key(from, group));
  for (uint32_t& piece : picked.piece) piece += groups.piece_first[group];
  RayPacket rays;
  float sent[kPacketSize], kernel[kPacketSize];
  start_at(rays, from.points[packet]);
  aim_at_pieces(rays, sent, groups, picked.piece, picked.u, picked.v);
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Emitter& piece = groups.pieces[picked.piece[k]];
    if (is_near(piece, {rays.origin_x[k], rays.origin_y[k], rays.origin_z[k]}))
      aim_at_near_piece(rays, sent[k], k, piece, luminance(groups.emission[picked.piece[k]]), picked.u[k],
                        picked.v[k]);
  }
  // Over the density: what the piece was picked by, spread over its area.
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float x = rays.direction_x[k], y = rays.direction_y[k], z = rays.direction_z[k];
    const float squared = x * x + y * y + z * z;
    const float cosine = std::max(x * normal.x + y * normal.y + z * normal.z, 0.0f);
    kernel[k] = cosine * sent[k] / (std::max(squared * squared, 1e-30f) * picked.strength[k]);
  }
  cast_pairs(sums, from, packet, rays, kernel);
}

}  // namespace

void add_visibility(VisibilitySums& sums, ElementPoints& from, const GroupLook& look,
                    const EmitterGroups& groups, uint32_t group, uint32_t first, uint32_t last) {
  make_packets(from, last);
  for (uint32_t packet = first; packet < last; ++packet)
    if (groups.is_sky(group))
      add_sky_packet(sums, from, packet, look, groups, group);
    else
      add_lamp_packet(sums, from, packet, look, groups, group);
}

}  // namespace patchlight
