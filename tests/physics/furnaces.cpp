// Furnaces: closed rooms whose light is the same everywhere, whatever the form factors are.
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <array>

using namespace patchlight;

namespace {

// Rows in a closed room sum to 1, so rounding alone separates the solver from these answers; the project
// promises area means within 1e-3 and every patch within 1e-2, of the value expected.
void check_uniform(const Solution& run, const FaceTable& faces, double expected) {
  for (uint32_t polygon = 0; polygon < next_polygon(faces); ++polygon) {
    CAPTURE(polygon);
    CHECK(std::abs(mean_radiosity(run, faces, polygon) / expected - 1) <= 1e-3);
  }
  double worst = 0;
  for (size_t row = 0; row < run.mesh.elements.size(); ++row) {
    if (run.mesh.elements.exposed[row] == 0) continue;
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(double{run.mesh.elements.radiosity[row][k]} / expected - 1));
  }
  CHECK(worst <= 1e-2);
}

FaceTable make_mixed_cube() {
  constexpr std::array<float, 6> kReflectance = {0.1f, 0.8f, 0.3f, 0.5f, 0.7f, 0.9f};
  BoxSurfaces surfaces;
  for (size_t k = 0; k < 6; ++k) surfaces[k] = make_surface(1 - kReflectance[k], kReflectance[k]);
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), surfaces);
  return faces;
}

}  // namespace

TEST_CASE("furnace: E = 1 and one rho in a closed box give B = (1 - rho^(k+1)) / (1 - rho) after pass k") {
  for (const float rho : {0.5f, 0.9f, 0.99f}) {
    CAPTURE(rho);
    FaceTable faces;
    add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, rho)));
    fit_scene(faces);
    const SolverSettings settings;
    Solution run = solve_scene(faces, settings, 0);
    for (const uint32_t pass : {1u, 2u, 16u}) {
      CAPTURE(pass);
      advance_to(run, pass);
      check_uniform(run, faces, (1 - std::pow(double{rho}, pass + 1)) / (1 - double{rho}));
    }
  }
}

TEST_CASE("furnace: E = 0.5 and rho = 0.5 in a closed box give B = 1") {
  FaceTable faces;
  add_box_inward(faces, {-1, 0, 2}, {3, 1, 4}, make_box_surfaces(make_surface(0.5f, 0.5f)));
  fit_scene(faces);
  // After 24 passes 0.5^25 = 3e-8 is missing.
  check_uniform(solve_scene(faces, {}, 24), faces, 1);
}

TEST_CASE("furnace: a starting mesh is not refined where nothing differs") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0.5f, 0.5f)));
  fit_scene(faces);
  CHECK(solve_scene(faces, {}, 0).log.rounds.size() == 1);
}

// The series goes on for all bounces: rho is 0.9 on one wall only, and the mean decays by less than 0.65 a
// pass; after 48 passes less than 1e-8 is missing.
constexpr uint32_t kManyPasses = 48;

TEST_CASE("furnace: E_i = 1 - rho_i with mixed rho gives B = 1 in an empty cube") {
  FaceTable faces = make_mixed_cube();
  fit_scene(faces);
  check_uniform(solve_scene(faces, {}, kManyPasses), faces, 1);
}

TEST_CASE("furnace: E_i = 1 - rho_i with mixed rho gives B = 1 round a floating box") {
  FaceTable faces = make_mixed_cube();
  add_box_outward(faces, {0.3f, 0.3f, 0.2f}, {0.7f, 0.7f, 0.6f}, make_surface(0.4f, 0.6f));
  fit_scene(faces);
  check_uniform(solve_scene(faces, {}, kManyPasses), faces, 1);
}

TEST_CASE("furnace: E_i = 1 - rho_i gives B = 1 round a box that buries a part of the floor") {
  FaceTable faces = make_mixed_cube();
  // Without its bottom, which would look out of the room.
  const Vec3 low(0.3f, 0, 0.2f), high(0.7f, 0.4f, 0.6f);
  add_box_outward(faces, low, high, make_surface(0.4f, 0.6f));
  FaceTable open;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    if (f == 6 + kFloor) continue;
    const auto& c = faces.corners[f];
    add_quad(open, c[0], c[1], c[2], c[3], {faces.emission[f], faces.reflectance[f]});
  }
  fit_scene(open);
  const Solution run = solve_scene(open, {}, kManyPasses);
  check_uniform(run, open, 1);
  // 0.16 of the unit floor is buried, of a total area of 6 + 0.8. Elements are as small as a hundredth of the
  // floor's edge where the box stands, and each on its outline, 1.6 long, is known to an eighth.
  const double buried = 1 - exposed_area(run, open, kFloor, kFloor + 1) / face_area(open, kFloor);
  CHECK(std::abs(buried - 0.16) <= 1.6 * 0.01);
}

TEST_CASE("furnace: passes from below: B = 1 is approached and never exceeded") {
  FaceTable faces = make_mixed_cube();
  fit_scene(faces);
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 0);
  double before = 0;
  for (uint32_t pass = 1; pass <= 12; ++pass) {
    advance_to(run, pass);
    const double mean = mean_radiosity(run, faces, 0, 6);
    CHECK(mean > before);
    // Rounding of sums of 256 floats.
    CHECK(mean <= 1 + 1e-5);
    before = mean;
  }
}

TEST_CASE("furnace: colours do not mix: each channel has its own rho and E") {
  FaceTable faces;
  const Surface surface{Rgb(1, 0.5f, 0), Rgb(0.25f, 0.5f, 0.75f)};
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(surface));
  fit_scene(faces);
  const Solution run = solve_scene(faces, {}, 30);
  // E / (1 - rho); 30 bounces of 0.75 leave 2e-4, but that channel has no light at all.
  const DRgb mean = polygon_power(run, faces, 0, 6, run.mesh.elements.radiosity);
  CHECK(mean.r == doctest::Approx(4.0 / 3).epsilon(1e-3));
  CHECK(mean.g == doctest::Approx(1.0).epsilon(1e-3));
  CHECK(mean.b == 0);
}

TEST_CASE("furnace: a dozen triangles make as good a furnace as six quads") {
  FaceTable quads;
  add_box_inward(quads, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0.3f, 0.7f)));
  FaceTable faces;
  for (uint32_t f = 0; f < quads.size(); ++f) {
    const auto& c = quads.corners[f];
    const Surface surface{quads.emission[f], quads.reflectance[f]};
    add_face(faces, std::array{c[0], c[1], c[2]}, f, surface);
    add_face(faces, std::array{c[2], c[3], c[0]}, f, surface);
  }
  fit_scene(faces);
  // 0.7^40 = 6e-7 is missing.
  check_uniform(solve_scene(faces, {}, 39), faces, 1);
}
