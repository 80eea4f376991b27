// Faces and cells to lamps; a point and a lamp to a form factor.
#include "lamps.h"

#include "lambert.h"
#include "sampling.h"

#include <algorithm>
#include <span>

namespace patchlight {
namespace {

// A lamp this many times smaller than its distance is a point to the closed form (error about 1e-3 of it at
// most).
constexpr float kFarLamp = 0.05f;
// A lamp that looks smaller than this takes four points: the rule's error on 1 / r^4 is 0.1 (size /
// distance)^4.
constexpr float kNearbyLamp = 0.15f;

// 0 for a whole face.
uint64_t make_cell_key(uint32_t cell, uint32_t level) {
  return level == 0 ? 0 : mix_bits(uint64_t{cell} << 8 | level);
}

}  // namespace

Lamp make_lamp(const FaceTable& faces, const FaceFrameTable& frames, uint32_t face, uint32_t cell,
               uint32_t level) {
  const CellFrame place = make_cell_frame(frames.triangle[face], cell, level);
  Lamp lamp{face,
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
  for (size_t a = 0; a < lamp.corner_count; ++a)
    for (size_t b = 0; b < a; ++b)
      lamp.diameter = std::max(lamp.diameter, distance(lamp.corners[a], lamp.corners[b]));
  for (size_t k = 0; k < 4; ++k)
    lamp.gauss[k] = face_point(frames, face, place.origin + place.size * Vec2(kGauss[k % 2], kGauss[k / 2]));
  if (!frames.affine[face])
    lamp.twist = {dot(frames.twist[face], frames.dual_u[face]), dot(frames.twist[face], frames.dual_v[face])};
  return lamp;
}

std::vector<Lamp> make_lamps(const FaceTable& faces, const FaceFrameTable& frames) {
  std::vector<Lamp> lamps;
  for (uint32_t f = 0; f < faces.size(); ++f)
    if (largest(faces.emission[f]) > 0) lamps.push_back(make_lamp(faces, frames, f));
  return lamps;
}

float find_factor(Vec3 point, Vec3 normal, const Lamp& lamp) {
  const Vec3 way = lamp.centre - point;
  const float distance_squared = dot(way, way);
  if (lamp.diameter * lamp.diameter < kFarLamp * kFarLamp * distance_squared) {
    const float cosines = dot(way, normal) * -dot(way, lamp.normal);
    if (dot(way, normal) <= 0 || cosines <= 0) return 0;
    return cosines * lamp.area / (kPi * distance_squared * distance_squared);
  }
  if (lamp.is_parallelogram && lamp.diameter * lamp.diameter < kNearbyLamp * kNearbyLamp * distance_squared) {
    float sum = 0;
    bool above = true;
    for (const Vec3& p : lamp.gauss) {
      const Vec3 to = p - point;
      const float squared = dot(to, to), cosine = dot(to, normal);
      // The corners lie 1.74 times as far out as these points: near the horizon the closed form cuts them.
      above &= cosine > lamp.diameter;
      sum += cosine * -dot(to, lamp.normal) / (squared * squared);
    }
    if (above) return std::max(sum * lamp.area / (4 * kPi), 0.0f);
  }
  return static_cast<float>(
      find_point_form_factor(DVec3(point), DVec3(normal), std::span(lamp.corners).first(lamp.corner_count)));
}

bool can_reach(const std::array<Vec3, 4>& patch, Vec3 normal, const Lamp& lamp) {
  const auto any_above = [](const std::array<Vec3, 4>& points, Vec3 base, Vec3 up, float slack) {
    return std::any_of(points.begin(), points.end(), [&](Vec3 p) { return dot(p - base, up) > slack; });
  };
  const float slack = ray_offset(patch[0]);
  return any_above(lamp.corners, patch[0], normal, slack) &&
         any_above(patch, lamp.centre, lamp.normal, slack);
}

}  // namespace patchlight
