#include "engine/solve/dark.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

TEST_CASE("dark: a lamp reaches what it faces, and nothing behind a back or beside") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, make_surface(0, 0.5f));  // a floor
  // Down at the floor, up and away from it, and down at the back of a board.
  add_quad(faces, {0.2f, 1, 0.2f}, {0.8f, 1, 0.2f}, {0.8f, 1, 0.8f}, {0.2f, 1, 0.8f}, make_surface(1, 0));
  add_quad(faces, {0.2f, 1.2f, 0.8f}, {0.8f, 1.2f, 0.8f}, {0.8f, 1.2f, 0.2f}, {0.2f, 1.2f, 0.2f},
           make_surface(1, 0));
  add_quad(faces, {5, 1, 0}, {6, 1, 0}, {6, 1, 1}, {5, 1, 1}, make_surface(1, 0));
  add_quad(faces, {2, 0.5f, -3}, {9, 0.5f, -3}, {9, 0.5f, 4}, {2, 0.5f, 4}, make_surface(0, 0.5f));
  fit_scene(faces);
  const Solution run = solve_scene(faces, {}, 1);
  CHECK(find_reaching(run) == std::vector<uint8_t>{0, 1, 0, 0, 0});
  CHECK(reflects_light(faces));
  faces.reflectance.assign(faces.size(), Rgb(0));
  CHECK_FALSE(reflects_light(faces));
}

TEST_CASE("dark: where all emits and rows see it, all of it reaches something") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 0.5f)));
  fit_scene(faces);
  const Solution run = solve_scene(faces, {}, 1);
  CHECK(find_reaching(run) == std::vector<uint8_t>(6, 1));
}
