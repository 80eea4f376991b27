#include "engine/solve/leaks.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace patchlight;

namespace {

// A room of 1 x 1 x 1 without its left wall, and what is put there instead.
FaceTable make_room_without_left() {
  FaceTable box, faces;
  add_box_inward(box, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.5f)));
  for (uint32_t f = 0; f < box.size(); ++f)
    if (box.polygon[f] != kLeft)
      add_polygon(faces, std::span(box.corners[f]).first(4), make_surface(0, 0.5f));
  return faces;
}

LeakReport find_leaks_of(FaceTable faces) {
  fit_scene(faces);
  const SolverSettings settings{.patch_count_max = 4000};
  const Solution run = solve_scene(faces, settings, 0);
  return find_leaks(run);
}

}  // namespace

TEST_CASE("a closed room leaks nothing") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.5f)));
  const LeakReport leaks = find_leaks_of(faces);
  CHECK(leaks.escaped == 0);
  CHECK(leaks.through_cracks == 0);
}

TEST_CASE("a wall that is too low lets light out past its upper edge, or the one above") {
  FaceTable faces = make_room_without_left();
  constexpr float kGap = 0.05f;
  add_quad(faces, {0, 0, 0}, {0, 1 - kGap, 0}, {0, 1 - kGap, 1}, {0, 0, 1}, make_surface(0, 0.5f));
  const LeakReport leaks = find_leaks_of(faces);
  // In a nearly closed convex room what leaves is the gap's share of the area, 0.05 of 6: every point of the
  // gap is met from all sides evenly. A few thousand rays a hundredth of which leave: 10 %.
  CHECK(leaks.escaped == doctest::Approx(kGap / 6).epsilon(0.1));
  CHECK(leaks.through_cracks >= 0.9 * leaks.escaped);
  REQUIRE(leaks.face != kNone);
  const auto& corners = faces.corners[leaks.face];
  for (const Vec3& end : {corners[leaks.edge], corners[(leaks.edge + 1) % 4]}) {
    CHECK(end.x == 0);
    CHECK(end.y >= 1 - kGap);
  }
}

TEST_CASE("a window is no crack") {
  FaceTable faces = make_room_without_left();
  // The wall around an opening of 0.4 x 0.4 in its middle.
  const auto part = [&](float y0, float y1, float z0, float z1) {
    add_quad(faces, {0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}, make_surface(0, 0.5f));
  };
  part(0, 0.3f, 0, 1), part(0.7f, 1, 0, 1), part(0.3f, 0.7f, 0, 0.3f), part(0.3f, 0.7f, 0.7f, 1);
  const LeakReport leaks = find_leaks_of(faces);
  CHECK(leaks.escaped == doctest::Approx(0.16 / 6).epsilon(0.1));
  CHECK(leaks.through_cracks <= 0.1 * leaks.escaped);
}
