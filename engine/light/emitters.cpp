// Faces and cells to emitters; a point and an emitter to a form factor.
#include "engine/light/emitters.h"

#include "engine/base/sampling.h"
#include "engine/light/lambert.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace patchlight {
namespace {

// One this many times smaller than its distance is a point to the closed form (error about 1e-3 of it at
// most).
constexpr float kFarEmitter = 0.05f;
// One that looks smaller than this takes four points: the rule's error on 1 / r^4 is 0.1 (size /
// distance)^4.
constexpr float kNearbyEmitter = 0.15f;

// 0 for a whole face.
uint64_t make_cell_key(uint32_t cell, uint32_t level) {
  return level == 0 ? 0 : mix_bits(uint64_t{cell} << 8 | level);
}

}  // namespace

Emitter make_emitter(const FaceTable& faces, const FaceFrameTable& frames, const CellName& name) {
  const auto [face, cell, level] = name;
  const CellFrame place = make_cell_frame(frames.triangle[face], cell, level);
  Emitter emitter{face,
                  place,
                  (uint64_t{face} + 1) * 0x9e3779b97f4a7c15ull ^ make_cell_key(cell, level),
                  cell_centre(frames, face, cell, level),
                  faces.normal[face],
                  level == 0 ? faces.corners[face] : cell_corners(frames, face, cell, level),
                  faces.corner_count[face],
                  cell_area(frames, face, cell, level),
                  0,
                  Vec2(0),
                  {},
                  {}};
  for (size_t a = 0; a < emitter.corner_count; ++a)
    for (size_t b = 0; b < a; ++b)
      emitter.diameter = std::max(emitter.diameter, distance(emitter.corners[a], emitter.corners[b]));
  if (!frames.affine[face])
    emitter.twist = {dot(frames.twist[face], frames.dual_u[face]),
                     dot(frames.twist[face], frames.dual_v[face])};
  // Of a square, and of a triangle (Strang, Fix: An Analysis of the Finite Element Method, 1973, table 4.1).
  constexpr float kTriangle[4][3] = {{1 / 3.0f, 1 / 3.0f, -27 / 48.0f},
                                     {0.6f, 0.2f, 25 / 48.0f},
                                     {0.2f, 0.6f, 25 / 48.0f},
                                     {0.2f, 0.2f, 25 / 48.0f}};
  const bool triangle = frames.triangle[face];
  float all = 0;
  for (size_t k = 0; k < 4; ++k) {
    const Vec2 in_cell =
        triangle ? Vec2(kTriangle[k][0], kTriangle[k][1]) : Vec2(kGauss[k % 2], kGauss[k / 2]);
    const Vec2 uv = place.origin + place.size * in_cell;
    emitter.gauss[k] = face_point(frames, face, uv);
    all += emitter.gauss_area[k] =
        triangle ? kTriangle[k][2] : 1 + uv.y * emitter.twist.x + uv.x * emitter.twist.y;
  }
  for (float& area : emitter.gauss_area) area *= emitter.area / all;
  return emitter;
}

float find_point_factor(Vec3 point, Vec3 normal, const Emitter& emitter) {
  const Vec3 way = emitter.centre - point;
  const float distance_squared = dot(way, way);
  if (emitter.diameter * emitter.diameter < kFarEmitter * kFarEmitter * distance_squared) {
    const float cosines = dot(way, normal) * -dot(way, emitter.normal);
    if (dot(way, normal) <= 0 || cosines <= 0) return 0;
    return cosines * emitter.area / (kPi * distance_squared * distance_squared);
  }
  if (emitter.diameter * emitter.diameter < kNearbyEmitter * kNearbyEmitter * distance_squared) {
    float sum = 0;
    bool above = true;
    for (size_t k = 0; k < 4; ++k) {
      const Vec3 to = emitter.gauss[k] - point;
      const float squared = dot(to, to), cosine = dot(to, normal);
      // The corners lie 1.74 times as far out as these points: near the horizon the closed form cuts them.
      above &= cosine > emitter.diameter;
      sum += emitter.gauss_area[k] * cosine * -dot(to, emitter.normal) / (squared * squared);
    }
    if (above) return std::max(sum / kPi, 0.0f);
  }
  return static_cast<float>(find_point_form_factor(DVec3(point), DVec3(normal),
                                                   std::span(emitter.corners).first(emitter.corner_count)));
}

namespace {

// A face is cut until each cell of it, weighed by the fourth root of the face's share of all power, looks
// smaller than this: a wide sky is fine where it is near and coarse where it is far.
constexpr float kPieceAngle = 0.125f;
constexpr uint8_t kPieceLevelMax = 12;
constexpr size_t kPiecesWanted = 1024;
// Lamps whose emissions differ by more than this are in no group together: a strong one that is hidden would
// take the rays of a weak one that is seen.
constexpr float kGroupEmission = 8;
// Pieces no further off than so many times the nearest are beside one: on a grid, all eight.
constexpr float kBeside = 1.6f;

// All faces that emit, in their order.
std::vector<Emitter> make_emitters(const FaceTable& faces, const FaceFrameTable& frames) {
  std::vector<Emitter> emitters;
  for (uint32_t f = 0; f < faces.size(); ++f)
    if (largest(faces.emission[f]) > 0) emitters.push_back(make_emitter(faces, frames, {f}));
  return emitters;
}

// Where what reflects is: its box, and the square root of its area.
struct Lit {
  Vec3 low{1e30f}, high{-1e30f};
  float scale = 0;
};

// How wide a cell looks from about the nearest of what reflects.
float find_angle(const FaceFrameTable& frames, const CellName& name, const Lit& lit) {
  const auto corners = cell_corners(frames, name.face, name.cell, name.level);
  const float diameter =
      std::max({distance(corners[0], corners[2]), distance(corners[1], corners[3]), longest_edge(corners)});
  const Vec3 centre = cell_centre(frames, name.face, name.cell, name.level);
  return std::min(diameter / (0.15f * lit.scale + distance(clamp(centre, lit.low, lit.high), centre)), 2.0f);
}

struct PieceName {
  uint32_t face, cell;
  uint8_t level;
  Vec3 centre;
};

// Cuts a cell until its parts look smaller than `angle`; no more than `count_max` pieces in all.
void cut_face(std::vector<PieceName>& names, const FaceFrameTable& frames, const CellName& name, float angle,
              const Lit& lit, size_t count_max) {
  if (names.size() > count_max) return;
  if (name.level == kPieceLevelMax || find_angle(frames, name, lit) <= angle) {
    names.push_back({name.face, name.cell, static_cast<uint8_t>(name.level),
                     cell_centre(frames, name.face, name.cell, name.level)});
    return;
  }
  for (uint32_t child = 0; child < 4; ++child)
    cut_face(names, frames, {name.face, name.cell | child << (30 - 2 * name.level), name.level + 1}, angle,
             lit, count_max);
}

PieceFrame make_piece_frame(const Emitter& piece, const FaceFrameTable& frames, float emission) {
  const Vec3 origin = frames.origin[piece.face], u = frames.edge_u[piece.face], v = frames.edge_v[piece.face],
             twist = frames.twist[piece.face];
  const Vec2 at = piece.cell.origin;
  const float size = piece.cell.size;
  return {origin + at.x * u + at.y * v + at.x * at.y * twist,
          size * (u + at.y * twist),
          size * (v + at.x * twist),
          size * size * twist,
          piece.normal,
          {1 + at.y * piece.twist.x + at.x * piece.twist.y, size * piece.twist.y, size * piece.twist.x},
          piece.area * emission,
          frames.triangle[piece.face] ? 1.0f : 0.0f};
}

// Halves a run of pieces across its longest axis until groups are small enough.
void split_group(std::vector<PieceName>& names, uint32_t first, uint32_t last, std::vector<uint32_t>& ends) {
  if (last - first <= kGroupPiecesMax) {
    ends.push_back(last);
    return;
  }
  Vec3 low(1e30f), high(-1e30f);
  for (uint32_t k = first; k < last; ++k) low = min(low, names[k].centre), high = max(high, names[k].centre);
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = first + (last - first) / 2;
  std::nth_element(names.begin() + first, names.begin() + middle, names.begin() + last,
                   [&](const PieceName& a, const PieceName& b) {
                     return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis]
                            : a.face != b.face               ? a.face < b.face
                                                             : a.cell < b.cell;
                   });
  split_group(names, first, middle, ends);
  split_group(names, middle, last, ends);
}

// Which pieces each face has, by their cells, and which group has each piece.
void index_pieces(EmitterGroups& groups, const std::vector<PieceName>& names, size_t face_count) {
  for (uint32_t g = 0; g < groups.size(); ++g) groups.group_of.resize(groups.piece_first[g + 1], g);
  groups.of_face.resize(names.size());
  std::iota(groups.of_face.begin(), groups.of_face.end(), 0u);
  std::sort(groups.of_face.begin(), groups.of_face.end(), [&](uint32_t a, uint32_t b) {
    return names[a].face != names[b].face ? names[a].face < names[b].face : names[a].cell < names[b].cell;
  });
  groups.face_first.assign(face_count + 1, 0);
  for (const PieceName& name : names) {
    groups.cell.push_back(name.cell);
    ++groups.face_first[name.face + 1];
  }
  std::partial_sum(groups.face_first.begin(), groups.face_first.end(), groups.face_first.begin());
}

// Groups of the sky's cells, as they lie side by side, and one of the sun alone.
void add_sky(EmitterGroups& groups, const Sky& sky, SkyDetail detail) {
  groups.sky = make_sky_pieces(sky, detail);
  const SkyPieces& pieces = groups.sky;
  const auto row_count = static_cast<uint32_t>(pieces.size());
  const uint32_t cell_count = row_count - (pieces.has_sun ? 1 : 0);
  const auto lamp_count = static_cast<uint32_t>(groups.pieces.size());
  groups.beside.resize(lamp_count + row_count);
  for (uint32_t first = 0; first < row_count;) {
    const uint32_t end =
        first == cell_count ? row_count : std::min(first + uint32_t{kGroupPiecesMax}, cell_count);
    for (uint32_t row = first; row < end; ++row) {
      uint64_t& mask = groups.beside[lamp_count + row] = uint64_t{1} << (row - first);
      for (uint32_t k = pieces.beside_first[row]; k < pieces.beside_first[row + 1]; ++k)
        if (const uint32_t other = pieces.beside[k]; other >= first && other < end)
          mask |= uint64_t{1} << (other - first);
    }
    groups.piece_first.push_back(lamp_count + end);
    ++groups.sky_group_count;
    first = end;
  }
}

}  // namespace

EmitterGroups make_emitter_groups(const FaceTable& faces, const FaceFrameTable& frames, const Sky& sky,
                                  SkyDetail detail) {
  const std::vector<Emitter> lamps = make_emitters(faces, frames);
  Lit lit;
  double area = 0, power = 0;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    if (largest(faces.reflectance[f]) == 0) continue;
    area += cell_area(frames, f, 0, 0);
    for (const Vec3& p : faces.corners[f]) lit.low = min(lit.low, p), lit.high = max(lit.high, p);
  }
  lit.scale = static_cast<float>(std::sqrt(area));
  for (const Emitter& lamp : lamps) power += double{lamp.area} * luminance(faces.emission[lamp.face]);
  const size_t count_max = std::max(kPiecesWanted, lamps.size());
  std::vector<PieceName> names;
  for (float wanted = area > 0 ? kPieceAngle : 1e30f;; wanted *= 1.5f) {
    names.clear();
    for (const Emitter& lamp : lamps) {
      const double share = lamp.area * luminance(faces.emission[lamp.face]) / power;
      const float weight = std::max(static_cast<float>(std::sqrt(std::sqrt(share))), 1e-6f);
      cut_face(names, frames, {lamp.face}, wanted / weight, lit, count_max);
    }
    if (names.size() <= count_max) break;
  }
  EmitterGroups groups;
  groups.piece_first.push_back(0);
  std::vector<uint32_t> ends;  // of the groups' pieces
  const auto emission_of = [&](const PieceName& name) { return luminance(faces.emission[name.face]); };
  std::stable_sort(names.begin(), names.end(),
                   [&](const PieceName& a, const PieceName& b) { return emission_of(a) > emission_of(b); });
  for (uint32_t first = 0, last = 0; first < names.size(); first = last) {
    const float brightest = emission_of(names[first]);
    while (last < names.size() && emission_of(names[last]) * kGroupEmission >= brightest) ++last;
    split_group(names, first, last, ends);
    groups.brightest.resize(ends.size(), brightest);
  }
  for (const uint32_t end : ends) {
    std::sort(
        names.begin() + groups.piece_first.back(), names.begin() + end,
        [](const auto& a, const auto& b) { return a.face != b.face ? a.face < b.face : a.cell < b.cell; });
    groups.piece_first.push_back(end);
  }
  for (const PieceName& name : names) {
    const Emitter piece = make_emitter(faces, frames, {name.face, name.cell, name.level});
    const Rgb emission = faces.emission[name.face];
    const Vec3 normal = piece.normal * (piece.area * luminance(emission) / kPi);
    groups.emission.push_back(emission);
    groups.x.push_back(piece.centre.x), groups.y.push_back(piece.centre.y),
        groups.z.push_back(piece.centre.z);
    groups.normal_x.push_back(normal.x), groups.normal_y.push_back(normal.y),
        groups.normal_z.push_back(normal.z);
    groups.diameter_squared.push_back(piece.diameter * piece.diameter);
    groups.frames.push_back(make_piece_frame(piece, frames, luminance(emission)));
    groups.pieces.push_back(piece);
  }
  index_pieces(groups, names, faces.size());
  groups.beside.resize(groups.pieces.size());
  for (size_t g = 0; g < groups.size(); ++g) {
    const uint32_t first = groups.piece_first[g], last = groups.piece_first[g + 1];
    for (uint32_t a = first; a < last; ++a) {
      float nearest = 1e30f;
      for (uint32_t b = first; b < last; ++b)
        if (b != a) nearest = std::min(nearest, distance(groups.pieces[a].centre, groups.pieces[b].centre));
      for (uint32_t b = first; b < last; ++b)
        if (distance(groups.pieces[a].centre, groups.pieces[b].centre) <= kBeside * nearest || b == a)
          groups.beside[a] |= uint64_t{1} << (b - first);
    }
  }
  add_sky(groups, sky, detail);
  return groups;
}

uint32_t find_piece(const EmitterGroups& groups, uint32_t face, uint32_t cell) {
  if (face + 1 >= groups.face_first.size()) return kNone;
  const auto begin = groups.of_face.begin() + groups.face_first[face],
             end = groups.of_face.begin() + groups.face_first[face + 1];
  const auto after = std::upper_bound(
      begin, end, cell, [&](uint32_t code, uint32_t piece) { return code < groups.cell[piece]; });
  return after == begin ? kNone : after[-1];
}

float find_strengths(std::span<float, kGroupPiecesMax> strength, const EmitterGroups& groups, size_t group,
                     Vec3 point, Vec3 normal) {
  const uint32_t first = groups.piece_first[group], count = groups.piece_count(group);
  const float *px = &groups.x[first], *py = &groups.y[first], *pz = &groups.z[first];
  const float *nx = &groups.normal_x[first], *ny = &groups.normal_y[first], *nz = &groups.normal_z[first];
  float* out = strength.data();
  for (uint32_t k = 0; k < count; ++k) {
    const float x = px[k] - point.x, y = py[k] - point.y, z = pz[k] - point.z;
    const float squared = x * x + y * y + z * z;
    const float cosine = std::max(x * normal.x + y * normal.y + z * normal.z, 0.0f);
    const float sent = std::max(-(x * nx[k] + y * ny[k] + z * nz[k]), 0.0f);
    out[k] = cosine * sent / std::max(squared * squared, 1e-30f);
  }
  float sum = 0;
  for (uint32_t k = 0; k < count; ++k) sum += out[k];
  return sum;
}

void aim_at_pieces(RayPacket& rays, std::span<float, kPacketSize> sent, const EmitterGroups& groups,
                   std::span<const uint32_t, kPacketSize> piece, std::span<const float, kPacketSize> u,
                   std::span<const float, kPacketSize> v) {
  // Lanes take what they need of their pieces one by one; loops over lanes then compile to wide instructions.
  float x[kPacketSize], y[kPacketSize], z[kPacketSize], nx[kPacketSize], ny[kPacketSize], nz[kPacketSize],
      strength[kPacketSize];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const PieceFrame& f = groups.frames[piece[k]];
    // As cell_sample() has it, without a branch.
    const float fold = 0.5f * f.triangle * std::min(u[k], v[k]), s = u[k] - fold, t = v[k] - fold;
    x[k] = f.origin.x + s * f.edge_u.x + t * f.edge_v.x + s * t * f.twist.x;
    y[k] = f.origin.y + s * f.edge_u.y + t * f.edge_v.y + s * t * f.twist.y;
    z[k] = f.origin.z + s * f.edge_u.z + t * f.edge_v.z + s * t * f.twist.z;
    nx[k] = f.normal.x, ny[k] = f.normal.y, nz[k] = f.normal.z;
    strength[k] = f.strength * (f.jacobian.x + s * f.jacobian.y + t * f.jacobian.z);
  }
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float ox = rays.origin_x[k], oy = rays.origin_y[k], oz = rays.origin_z[k];
    const float off = ray_offset({ox, oy, oz}, {x[k], y[k], z[k]});
    const float to_x = x[k] + off * nx[k] - ox, to_y = y[k] + off * ny[k] - oy,
                to_z = z[k] + off * nz[k] - oz;
    sent[k] = std::max(-(to_x * nx[k] + to_y * ny[k] + to_z * nz[k]), 0.0f) * strength[k];
    rays.direction_x[k] = to_x, rays.direction_y[k] = to_y, rays.direction_z[k] = to_z;
    rays.near_distance[k] = 0, rays.far_distance[k] = 1;
  }
}

bool can_reach(const std::array<Vec3, 4>& patch, Vec3 normal, const Emitter& emitter) {
  const auto any_above = [](const std::array<Vec3, 4>& points, Vec3 base, Vec3 up, float slack) {
    return std::any_of(points.begin(), points.end(), [&](Vec3 p) { return dot(p - base, up) > slack; });
  };
  const float slack = ray_offset(patch[0]);
  return any_above(emitter.corners, patch[0], normal, slack) &&
         any_above(patch, emitter.centre, emitter.normal, slack);
}

}  // namespace patchlight
