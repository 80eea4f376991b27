// How a picture sees: points of it to directions, and places to points of it.
#pragma once

#include "engine/base/vector.h"

#include <span>
#include <string_view>

namespace patchlight {

struct Lens;
struct View;

// How all directions before an eye are laid out on a picture: a row of the table in projections.cpp.
struct Projection {
  std::string_view name;
  bool is_flat;      // a point x, y (-1..1, right and up) looks along forward + x right + y up
  bool hides_backs;  // it sees as a patch does: back sides hide what is behind them; others look through them
  // Half the width and height of the picture at distance 1; 1, 1 where that has no meaning.
  Vec2 (*find_half_size)(const View& view);
  bool (*covers)(const Lens& lens, Vec2 at);          // pixels from the top left
  Vec3 (*find_direction)(const Lens& lens, Vec2 at);  // unit, through a point that it covers
  // Where it shows what lies at `p`, right and up in half sizes, in the plane at distance 1.
  Vec2 (*find_place)(const Lens& lens, Vec2 p);
};

// The usual one first.
std::span<const Projection> projections();
// Null where none has that name.
const Projection* find_projection(std::string_view name);

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
