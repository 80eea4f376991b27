// Faces and cells to emitters; a point and an emitter to a form factor.
#include "engine/light/emitters.h"

#include "engine/base/sampling.h"
#include "engine/light/lambert.h"

#include <algorithm>
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
                  frames.affine[face] && !frames.triangle[face],
                  {}};
  for (size_t a = 0; a < emitter.corner_count; ++a)
    for (size_t b = 0; b < a; ++b)
      emitter.diameter = std::max(emitter.diameter, distance(emitter.corners[a], emitter.corners[b]));
  for (size_t k = 0; k < 4; ++k)
    emitter.gauss[k] =
        face_point(frames, face, place.origin + place.size * Vec2(kGauss[k % 2], kGauss[k / 2]));
  if (!frames.affine[face])
    emitter.twist = {dot(frames.twist[face], frames.dual_u[face]),
                     dot(frames.twist[face], frames.dual_v[face])};
  return emitter;
}

std::vector<Emitter> make_emitters(const FaceTable& faces, const FaceFrameTable& frames) {
  std::vector<Emitter> emitters;
  for (uint32_t f = 0; f < faces.size(); ++f)
    if (largest(faces.emission[f]) > 0) emitters.push_back(make_emitter(faces, frames, {f}));
  return emitters;
}

float find_point_factor(Vec3 point, Vec3 normal, const Emitter& emitter) {
  const Vec3 way = emitter.centre - point;
  const float distance_squared = dot(way, way);
  if (emitter.diameter * emitter.diameter < kFarEmitter * kFarEmitter * distance_squared) {
    const float cosines = dot(way, normal) * -dot(way, emitter.normal);
    if (dot(way, normal) <= 0 || cosines <= 0) return 0;
    return cosines * emitter.area / (kPi * distance_squared * distance_squared);
  }
  if (emitter.is_parallelogram &&
      emitter.diameter * emitter.diameter < kNearbyEmitter * kNearbyEmitter * distance_squared) {
    float sum = 0;
    bool above = true;
    for (const Vec3& p : emitter.gauss) {
      const Vec3 to = p - point;
      const float squared = dot(to, to), cosine = dot(to, normal);
      // The corners lie 1.74 times as far out as these points: near the horizon the closed form cuts them.
      above &= cosine > emitter.diameter;
      sum += cosine * -dot(to, emitter.normal) / (squared * squared);
    }
    if (above) return std::max(sum * emitter.area / (4 * kPi), 0.0f);
  }
  return static_cast<float>(find_point_form_factor(DVec3(point), DVec3(normal),
                                                   std::span(emitter.corners).first(emitter.corner_count)));
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
