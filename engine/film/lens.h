// How a picture sees: points of it to directions, and places to points of it.
#pragma once

#include "engine/base/vector.h"
#include "engine/film/projections.h"

namespace patchlight {

struct View {
  Vec3 eye, target, up;    // lengths
  float fov_degrees = 60;  // vertical; some projections have a fixed one
  uint32_t width = 0, height = 0;
  const Projection* projection = &projections()[0];
};

struct Lens {
  Vec3 eye, right, up,
      forward;          // right and up: half its width and height at distance 1, as the projection says
  float width, height;  // pixels
  const Projection* projection;

  // Pixels from the middle to the rim of a round picture.
  float radius() const { return std::min(width, height) / 2; }
  // From the middle, right and up, in radii.
  Vec2 from_middle(Vec2 at) const { return Vec2(at.x - width / 2, height / 2 - at.y) / radius(); }
  // False where the picture shows nothing: outside of a round one.
  bool covers(Vec2 at) const { return projection->covers(*this, at); }

  // Unit, through a point of the picture that it covers, in pixels from the top left.
  Vec3 find_direction(Vec2 at) const { return projection->find_direction(*this, at); }

  // Where a place is seen, in pixels from the top left; false behind the eye.
  bool find_place(Vec3 place, Vec2& at) const {
    const Vec3 way = place - eye;
    const float depth = dot(way, forward);
    if (depth <= 0) return false;
    at = projection->find_place(
        *this, Vec2(dot(way, right) / dot(right, right) / depth, dot(way, up) / dot(up, up) / depth));
    return true;
  }
};

inline Lens make_lens(const View& view) {
  const Vec3 forward = normalize(view.target - view.eye), right = normalize(cross(forward, view.up));
  const Vec2 half = view.projection->find_half_size(view);
  return {view.eye,
          right * half.x,
          cross(right, forward) * half.y,
          forward,
          static_cast<float>(view.width),
          static_cast<float>(view.height),
          view.projection};
}

}  // namespace patchlight
