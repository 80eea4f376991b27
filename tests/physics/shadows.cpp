// Shadow edges: where they lie, that the mesh follows them, and sunlight through a window.
#include "engine/light/lambert.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace patchlight;

namespace {

Vec3 element_centre(const Solution& s, size_t row) {
  return cell_centre(s.surfaces->frames, s.mesh.elements.face[row], s.mesh.elements.cell[row],
                     s.mesh.elements.level[row]);
}

// A room 6 x 3 x 7 with one window in its wall x = 0, that a small far sun shines through, in metres.
struct SunRoom {
  FaceTable faces;
  uint32_t window_first, window_last;  // polygons of the window wall
  uint32_t sun;
  Vec3 sun_centre, towards_sun;
  float scale;
};

constexpr float kWindowLow = 0.8f, kWindowHigh = 2.4f, kWindowFrom = 2.5f, kWindowTo = 4.5f;

SunRoom make_sun_room() {
  SunRoom room;
  FaceTable& faces = room.faces;
  const Surface white = make_surface(0, 0.75f), floor = {Rgb(0), Rgb(0.55f, 0.42f, 0.3f)};
  add_quad(faces, {0, 0, 0}, {0, 0, 7}, {6, 0, 7}, {6, 0, 0}, floor);
  add_quad(faces, {0, 3, 0}, {6, 3, 0}, {6, 3, 7}, {0, 3, 7}, white);
  add_quad(faces, {6, 0, 0}, {6, 0, 7}, {6, 3, 7}, {6, 3, 0}, white);
  add_quad(faces, {0, 0, 7}, {0, 3, 7}, {6, 3, 7}, {6, 0, 7}, white);
  add_quad(faces, {0, 0, 0}, {6, 0, 0}, {6, 3, 0}, {0, 3, 0}, white);
  const std::array<float, 4> y = {0, kWindowLow, kWindowHigh, 3}, z = {0, kWindowFrom, kWindowTo, 7};
  room.window_first = next_polygon(faces);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      if (i != 1 || j != 1)
        add_quad(faces, {0, y[j], z[i]}, {0, y[j + 1], z[i]}, {0, y[j + 1], z[i + 1]}, {0, y[j], z[i + 1]},
                 white);
  room.window_last = next_polygon(faces);
  room.sun_centre = {-60, 45, 10};
  room.towards_sun = normalize(room.sun_centre - Vec3(3, 0, 3.5f));
  const Vec3 n = -room.towards_sun, u = normalize(cross(Vec3(0, 1, 0), n)), v = cross(n, u);
  const float h = 0.35f;
  const Vec3 c = room.sun_centre;
  room.sun = add_quad(faces, c - h * u - h * v, c + h * u - h * v, c + h * u + h * v, c - h * u + h * v,
                      make_surface(1e5f, 0));
  room.scale = fit_scene(faces);
  return room;
}

// How deep in the light from the middle of the sun a point of the room is: metres from the window's frame on
// the plane of the window, positive inside.
float find_depth(const SunRoom& room, Vec3 metres) {
  const Vec3 way = room.sun_centre - metres;
  const Vec3 through = metres + (0 - metres.x) / way.x * way;
  return std::min(
      {through.y - kWindowLow, kWindowHigh - through.y, through.z - kWindowFrom, kWindowTo - through.z});
}

}  // namespace

TEST_CASE("the finest leaves lie on the shadow's edge, and none elsewhere") {
  // A small lamp above a floor, a square screen between: the shadow is a square with a narrow penumbra.
  FaceTable faces;
  add_quad(faces, {-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, make_surface(0, 0.5f));
  constexpr float kLamp = 0.005f;
  add_quad(faces, {-kLamp, 2, -kLamp}, {kLamp, 2, -kLamp}, {kLamp, 2, kLamp}, {-kLamp, 2, kLamp},
           make_surface(1e5f, 0));
  add_two_sided(faces,
                std::array{Vec3(-0.15f, 1, -0.15f), Vec3(0.15f, 1, -0.15f), Vec3(0.15f, 1, 0.15f),
                           Vec3(-0.15f, 1, 0.15f)},
                {}, {});
  const float scale = fit_scene(faces);
  const Solution run = solve_scene(faces, {}, 1);
  const Solution& s = run;
  const uint32_t last = s.mesh.elements.face_first[1];
  const uint32_t deepest =
      *std::max_element(s.mesh.elements.level.begin(), s.mesh.elements.level.begin() + last);
  const uint32_t start =
      *std::min_element(s.mesh.elements.level.begin(), s.mesh.elements.level.begin() + last);
  CHECK(deepest >= start + 3);
  size_t on_edge = 0;
  for (uint32_t row = 0; row < last; ++row) {
    if (s.mesh.elements.level[row] < deepest) continue;
    const Vec3 p = element_centre(s, row) / scale;
    const float edge = longest_edge(cell_corners(s.surfaces->frames, 0, s.mesh.elements.cell[row],
                                                 s.mesh.elements.level[row])) /
                       scale;
    // The shadow of the lamp's middle is 0.3 to each side; the penumbra kLamp wide to each side. A leaf is
    // split for a difference to a neighbour, so its parent or its parent's neighbour touches the penumbra, or
    // a leaf beside that for balance: four parents' edges.
    const float from_edge = std::abs(std::max(std::abs(p.x), std::abs(p.z)) - 0.3f);
    CHECK(from_edge <= kLamp + 8 * edge);
    ++on_edge;
  }
  // A line 2.4 long of leaves, at least one wide.
  const float edge = std::ldexp(2.0f, -static_cast<int>(deepest));
  CHECK(static_cast<float>(on_edge) >= 2.4f / edge);
  // Every stretch of the edge is followed.
  for (int k = 0; k < 64; ++k) {
    const float t = -0.28f + 0.56f * static_cast<float>(k % 16) / 15;
    const Vec3 p = scale * (k < 16   ? Vec3(t, 0, 0.3f)
                            : k < 32 ? Vec3(t, 0, -0.3f)
                            : k < 48 ? Vec3(0.3f, 0, t)
                                     : Vec3(-0.3f, 0, t));
    const uint32_t row =
        find_leaf(s.mesh.elements, 0, find_cell(false, find_face_parameters(s.surfaces->frames, 0, p)));
    CHECK(s.mesh.elements.level[row] + 1u >= deepest);
  }
}

TEST_CASE("sun through a window: the spot has the closed form's irradiance, the rest is black in pass 1") {
  const SunRoom room = make_sun_room();
  const Solution run = solve_scene(room.faces, {}, 1);
  const Solution& s = run;
  const auto irradiance = element_irradiance(s);
  const auto& sun = room.faces.corners[room.sun];
  // The sun is 0.7 wide, 75 away: its light through a frame's edge up to 11 away blurs by 0.7 * 11 / 75 at
  // most.
  constexpr float kBlur = 0.11f;
  size_t lit = 0, dark = 0;
  double worst = 0;
  for (uint32_t row = 0; row < s.mesh.elements.face_first[room.sun]; ++row) {
    const uint32_t face = s.mesh.elements.face[row];
    const Vec3 centre = element_centre(s, row), normal = room.faces.normal[face];
    const float depth = find_depth(room, centre / room.scale);
    const float reach = kBlur + longest_edge(cell_corners(s.surfaces->frames, face, s.mesh.elements.cell[row],
                                                          s.mesh.elements.level[row])) /
                                    room.scale;
    const bool window_wall = face >= room.window_first && face < room.window_last;
    if (window_wall) {
      // It looks away from the sun.
      REQUIRE(irradiance[row] == Rgb(0));
      REQUIRE(s.mesh.elements.radiosity[row] == Rgb(0));
    } else if (depth > reach && dot(normal, room.towards_sun) > 0) {
      const double expected = 1e5 * find_point_form_factor(DVec3(centre), DVec3(normal), sun);
      worst = std::max(worst, std::abs(irradiance[row].g / expected - 1));
      ++lit;
    } else if (depth < -reach || dot(normal, room.towards_sun) < 0) {
      REQUIRE(irradiance[row] == Rgb(0));
      ++dark;
    }
  }
  CHECK(lit > 20);
  CHECK(dark > 1000);
  // A lamp a hundred times smaller than its distance: as a point within (0.7 / 75)^2.
  CHECK(worst <= 1e-3);
}

TEST_CASE("sun through a window: the power of the spot is the sun's light on the window") {
  const SunRoom room = make_sun_room();
  const Solution run = solve_scene(room.faces, {}, 1);
  double found = 0;
  for (uint32_t polygon = 0; polygon < room.sun; ++polygon)
    found += polygon_power(run, room.faces, polygon, polygon + 1, element_irradiance(run)).g;
  // All that passes the window lands on the room's sides: the form factor from the window, looking out, to
  // the sun.
  FaceTable window;
  const uint32_t hole = add_quad(window, {0, kWindowLow, kWindowFrom}, {0, kWindowLow, kWindowTo},
                                 {0, kWindowHigh, kWindowTo}, {0, kWindowHigh, kWindowFrom}, {});
  CHECK(window.normal[hole].x < 0);
  map_scene(window, room.scale, Vec3(0));
  double factor = 0;
  for (int k = 0; k < 64; ++k) {
    const Vec2 p((static_cast<float>(k % 8) + 0.5f) / 8, (static_cast<float>(k / 8) + 0.5f) / 8);
    const Vec3 point = face_point(make_face_frames(window), 0, p);
    factor +=
        find_point_form_factor(DVec3(point), DVec3(window.normal[0]), room.faces.corners[room.sun]) / 64;
  }
  const double expected = 1e5 * factor * face_area(window, 0);
  // Noise lies in the penumbra alone, some 2e-1 of the spot's area, in hundreds of elements of 64 rays; the
  // sun's light on the outer walls' backs does not count.
  CHECK(std::abs(found / expected - 1) <= 2e-3);
}
