#include "engine/mesh/quadtree.h"
#include "engine/solve/solve.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace patchlight;

TEST_CASE("ledger: before the first pass all power is unshot") {
  const FaceTable faces = make_furnished_room();
  Solution run = solve_scene(faces, {}, 0);
  freeze(run);
  const PowerLedger ledger = find_power_ledger(run);
  CHECK(ledger.unshot == ledger.emitted);
  CHECK(ledger.closure_error == 0);
  double emitted = 0;
  for (uint32_t f = 0; f < faces.size(); ++f) emitted += face_area(faces, f) * faces.emission[f].g;
  CHECK(ledger.emitted.g == doctest::Approx(emitted).epsilon(1e-6));
}

TEST_CASE("ledger: it closes within 3e-3 at the defaults after every pass") {
  const FaceTable faces = make_furnished_room();
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 0);
  for (const uint32_t pass : {1u, 2u, 3u, 16u}) {
    CAPTURE(pass);
    advance_to(run, pass);
    const PowerLedger ledger = find_power_ledger(run);
    // What the project promises.
    CHECK(ledger.closure_error <= 3e-3);
    // The room is closed: only origins a millionth off their surface, where two meet, may look out.
    CHECK(ledger.escaped.g <= 1e-4 * ledger.emitted.g);
    for (int k = 0; k < 3; ++k) {
      CHECK(ledger.absorbed[k] >= 0);
      CHECK(ledger.unshot[k] >= 0);
    }
  }
}

TEST_CASE("ledger: without lamps everything is zero and nothing divides by it") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.5f)));
  fit_scene(faces);
  const SolverSettings settings;
  const Solution run = solve_scene(faces, settings, 2);
  const PowerLedger ledger = find_power_ledger(run);
  CHECK(ledger.emitted == DRgb(0));
  CHECK(ledger.absorbed == DRgb(0));
  CHECK(ledger.closure_error == 0);
  CHECK(is_converged(run));
}

TEST_CASE("ledger: a lone lamp loses all of its power, a back side takes what it meets") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, make_surface(2, 0.5f));
  const SolverSettings settings;
  const Solution lone = solve_scene(faces, settings, 1);
  const PowerLedger all = find_power_ledger(lone);
  CHECK(all.escaped.g == doctest::Approx(2).epsilon(1e-6));
  CHECK(all.absorbed.g == 0);
  add_quad(faces, {0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}, {});
  const Solution covered = solve_scene(faces, settings, 1);
  const PowerLedger ledger = find_power_ledger(covered);
  // Howell C-11; 65536 rays.
  CHECK(std::abs(ledger.absorbed.g / 2 - 0.199824895698) <= 4 * std::sqrt(0.2 * 0.8 / 65536));
  CHECK(std::abs(ledger.escaped.g / 2 - (1 - 0.199824895698)) <= 4 * std::sqrt(0.2 * 0.8 / 65536));
}

TEST_CASE("ledger: power does not depend on how finely the scene is split") {
  const FaceTable faces = make_furnished_room();
  double emitted[2], absorbed[2];
  for (int fine = 0; fine < 2; ++fine) {
    SolverSettings settings;
    settings.patch_size = fine ? 0.02f : 0.1f;
    const Solution run = solve_scene(faces, settings, 8);
    const PowerLedger ledger = find_power_ledger(run);
    emitted[fine] = ledger.emitted.g, absorbed[fine] = ledger.absorbed.g;
  }
  CHECK(emitted[0] == doctest::Approx(emitted[1]).epsilon(1e-6));
  // Each closes within 3e-3 of what was emitted.
  CHECK(std::abs(absorbed[0] - absorbed[1]) <= 2 * 3e-3 * emitted[0]);
}

TEST_CASE("ledger: it closes with 37 lamps, which are looked at in turn as all other numbers are") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.5f)));
  add_box_outward(faces, {0.3f, 0.2f, 0.3f}, {0.7f, 0.3f, 0.7f}, make_surface(0, 0.5f));
  for (int k = 0; k < 37; ++k) {
    const float x = 0.02f + 0.026f * static_cast<float>(k);
    add_quad(faces, {x, 0.9f, 0.49f}, {x + 0.02f, 0.9f, 0.49f}, {x + 0.02f, 0.9f, 0.51f}, {x, 0.9f, 0.51f},
             make_surface(10, 0));
  }
  fit_scene(faces);
  CHECK(find_power_ledger(solve_scene(faces, {}, 1)).closure_error <= 3e-3);
}

TEST_CASE("ledger: it closes where a lamp dips into two solids that cut each other") {
  FaceTable faces;
  add_box_outward(faces, {-1.04f, -1.2f, 1.866f}, {-0.812f, 0.296f, 3.653f}, make_surface(0, 0.5f));
  const auto first = static_cast<uint32_t>(faces.size());
  add_box_outward(faces, {-2.741f, -2.136f, -2.332f}, {-1.928f, -0.472f, -0.002f}, make_surface(0, 0.7f));
  const double angle = -282.4 / 180 * std::numbers::pi;
  const auto turned = [&](Vec3 p) {
    const auto sine = static_cast<float>(std::sin(angle)), cosine = static_cast<float>(std::cos(angle));
    return Vec3(cosine * p.x + sine * p.z, p.y, cosine * p.z - sine * p.x);
  };
  for (uint32_t f = first; f < faces.size(); ++f) {
    for (Vec3& corner : faces.corners[f]) corner = turned(corner);
    faces.normal[f] = turned(faces.normal[f]);
  }
  const Vec3 normal = normalize(Vec3(0.927f, 0.681f, 1.983f)), centre(-1.1f, -0.453f, 1.583f);
  const Vec3 width = normalize(Vec3(1, 0, 0) - normal * normal.x) / 2.0f, height = cross(normal, width);
  add_quad(faces, centre - width - height, centre + width - height, centre + width + height,
           centre - width + height, make_surface(60, 0.05f));
  fit_scene(faces);
  CHECK(find_power_ledger(solve_scene(faces, {}, 6)).closure_error <= 3e-3);
}
