// The table of projections.
#include "engine/film/lens.h"

#include <cmath>

namespace patchlight {
namespace {

bool covers_all(const Lens&, Vec2) { return true; }

// What a plane between the eye and the scene shows: straight edges stay straight.
Vec2 find_perspective_size(const View& view) {
  const float half_height = std::tan(view.fov_degrees * kPi / 360);
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  return {half_height * aspect, half_height};
}

Vec3 find_perspective_direction(const Lens& lens, Vec2 at) {
  const float x = 2 * at.x / lens.width - 1, y = 1 - 2 * at.y / lens.height;
  return normalize(lens.forward + x * lens.right + y * lens.up);
}

Vec2 find_perspective_place(const Lens& lens, Vec2 p) {
  return {(p.x + 1) / 2 * lens.width, (1 - p.y) / 2 * lens.height};
}

// The half of all directions around that of the target, in a circle: what lies 45 degrees off the middle is
// seen half way to its rim (an equidistant fisheye).
Vec2 find_fisheye_size(const View&) { return Vec2(1); }

bool is_in_circle(const Lens& lens, Vec2 at) { return dot(lens.from_middle(at), lens.from_middle(at)) < 1; }

Vec3 find_fisheye_direction(const Lens& lens, Vec2 at) {
  const Vec2 p = lens.from_middle(at);
  const float share = length(p), angle = share * kPi / 2;
  if (share == 0) return lens.forward;
  return std::cos(angle) * lens.forward + std::sin(angle) / share * (p.x * lens.right + p.y * lens.up);
}

Vec2 find_fisheye_place(const Lens& lens, Vec2 p) {
  const float tangent = length(p), share = tangent > 0 ? std::atan(tangent) / (kPi / 2) / tangent : 0;
  return {lens.width / 2 + p.x * share * lens.radius(), lens.height / 2 - p.y * share * lens.radius()};
}

constexpr Projection kProjections[] = {
    {.name = "perspective",
     .is_flat = true,
     .hides_backs = false,
     .find_half_size = find_perspective_size,
     .covers = covers_all,
     .find_direction = find_perspective_direction,
     .find_place = find_perspective_place},
    {.name = "fisheye",
     .is_flat = false,
     .hides_backs = true,
     .find_half_size = find_fisheye_size,
     .covers = is_in_circle,
     .find_direction = find_fisheye_direction,
     .find_place = find_fisheye_place},
};

}  // namespace

std::span<const Projection> projections() { return kProjections; }

const Projection* find_projection(std::string_view name) {
  for (const Projection& row : kProjections)
    if (row.name == name) return &row;
  return nullptr;
}

}  // namespace patchlight
