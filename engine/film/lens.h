// How a picture sees: points of it to directions, and places to points of it.
#pragma once

#include "engine/base/vector.h"

namespace patchlight {

struct View {
  Vec3 eye, target, up;    // lengths
  float fov_degrees = 60;  // vertical
  uint32_t width = 0, height = 0;
  // The half of all directions around that of the target, in a circle: what lies 45 degrees off the middle is
  // seen half way to its rim (an equidistant fisheye). Such a picture sees as a patch does: back sides hide
  // what is behind them.
  bool hemisphere = false;
};

struct Lens {
  Vec3 eye, right, up,
      forward;          // of a flat picture: right and up are half its width and height at distance 1
  float width, height;  // pixels
  bool hemisphere;

  // Pixels from the middle to the rim of a hemisphere.
  float radius() const { return std::min(width, height) / 2; }
  // From the middle, right and up, in radii.
  Vec2 from_middle(Vec2 at) const { return Vec2(at.x - width / 2, height / 2 - at.y) / radius(); }
  // False outside of the hemisphere's circle.
  bool covers(Vec2 at) const { return !hemisphere || dot(from_middle(at), from_middle(at)) < 1; }

  // Unit, through a point of the picture that it covers, in pixels from the top left.
  Vec3 find_direction(Vec2 at) const {
    if (hemisphere) {
      const Vec2 p = from_middle(at);
      const float share = length(p), angle = share * kPi / 2;
      if (share == 0) return forward;
      return std::cos(angle) * forward + std::sin(angle) / share * (p.x * right + p.y * up);
    }
    const float x = 2 * at.x / width - 1, y = 1 - 2 * at.y / height;
    return normalize(forward + x * right + y * up);
  }

  // Where a place is seen, in pixels from the top left; false behind the eye.
  bool find_place(Vec3 place, Vec2& at) const {
    const Vec3 way = place - eye;
    const float depth = dot(way, forward);
    if (depth <= 0) return false;
    const Vec2 p(dot(way, right) / dot(right, right) / depth, dot(way, up) / dot(up, up) / depth);
    if (hemisphere) {
      const float tangent = length(p), share = tangent > 0 ? std::atan(tangent) / (kPi / 2) / tangent : 0;
      at = Vec2(width / 2 + p.x * share * radius(), height / 2 - p.y * share * radius());
    } else {
      at = Vec2((p.x + 1) / 2 * width, (1 - p.y) / 2 * height);
    }
    return true;
  }
};

inline Lens make_lens(const View& view) {
  const Vec3 forward = normalize(view.target - view.eye), right = normalize(cross(forward, view.up));
  const auto width = static_cast<float>(view.width), height = static_cast<float>(view.height);
  if (view.hemisphere) return {view.eye, right, cross(right, forward), forward, width, height, true};
  const float half_height = std::tan(view.fov_degrees * kPi / 360);
  const float aspect = width / height;
  return {
      view.eye, right * (half_height * aspect), cross(right, forward) * half_height, forward, width, height,
      false};
}

}  // namespace patchlight
