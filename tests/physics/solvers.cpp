// The three solvers against each other and against closed forms: they share a mesh, and little else.
#include "engine/solve/solvers.h"

#include "engine/factors/polygon_factors.h"
#include "engine/solve/solve_matrix.h"
#include "engine/solve/solve_shooting.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <stdexcept>

using namespace patchlight;

namespace {

// A room with a block that hides parts of it from each other, a coloured wall, and a large lamp in its
// ceiling.
FaceTable make_blocked_room() {
  FaceTable faces;
  BoxSurfaces surfaces = make_box_surfaces({Rgb(0), Rgb(0.7f, 0.6f, 0.5f)});
  surfaces[kLeft].reflectance = Rgb(0.6f, 0.1f, 0.1f);
  surfaces[kCeiling].emission = Rgb(1);
  add_box_inward(faces, Vec3(0), Vec3(1), surfaces);
  add_box_outward(faces, {0.3f, 0.2f, 0.3f}, {0.6f, 0.6f, 0.7f}, make_surface(0, 0.6f));
  fit_scene(faces);
  return faces;
}

// Elements that are the patches: no mesh of its own for direct light.
SolverSettings make_plain_settings(uint32_t rays) {
  SolverSettings settings;
  settings.patch_count_max = 800;
  settings.patch_size = 0.1f;  // lengths: larger than patches start unless asked for
  settings.threshold = 1e9f;
  settings.rays = rays;
  return settings;
}

Solution make_run(const FaceTable& faces, const SolverSettings& settings) {
  Solution run = solve_scene(faces, settings, 0);
  freeze(run);
  return run;
}

Solution solve_by(const char* name, const FaceTable& faces, const SolverSettings& settings) {
  Solution run = make_run(faces, settings);
  for (const Solver& solver : solvers())
    if (solver.name == std::string_view(name))
      while (!solver.is_converged(run) && run.log.passes.size() < 100'000) solver.advance(run);
  REQUIRE(!run.log.passes.empty());
  return run;
}

// Area means of the patches' green radiosity over each polygon.
std::vector<double> find_patch_polygon_means(const Solution& s, const FaceTable& faces,
                                             std::span<const double> radiosity) {
  std::vector<double> sum(next_polygon(faces), 0), area(sum.size(), 0);
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    const double exposed_area = double{s.mesh.patches.area[p]} * s.mesh.patches.exposed[p];
    sum[faces.polygon[s.mesh.patches.face[p]]] += exposed_area * radiosity[p];
    area[faces.polygon[s.mesh.patches.face[p]]] += exposed_area;
  }
  for (size_t k = 0; k < sum.size(); ++k) sum[k] /= area[k];
  return sum;
}

std::vector<double> take_green(std::span<const Rgb> values) {
  std::vector<double> green;
  for (const Rgb& value : values) green.push_back(double{value.g});
  return green;
}

}  // namespace

TEST_CASE("pass by pass the patches follow the Neumann series of all form factors, found another way") {
  const FaceTable faces = make_blocked_room();
  const SolverSettings settings = make_plain_settings(1024);
  Solution run = make_run(faces, settings);
  Solution& s = run;
  REQUIRE(s.mesh.elements.size() == s.mesh.patches.size());
  const FactorTable factors = find_element_factors(s);
  const size_t n = factors.size();
  std::vector<double> added(n), all(n), next(n);
  for (size_t i = 0; i < n; ++i) all[i] = added[i] = double{faces.emission[s.mesh.patches.face[i]].g};
  // Patch i's row errs by at most 1 / (2 sqrt(rays)) of the range of what is sent, which is at most 1, and
  // so by less than 0.016; a polygon of at least 16 patches by a quarter of that, on average over its passes
  // less than four standard errors: 0.016 times rho <= 0.6, each pass. Strata make it several times smaller.
  // What is off in one pass is sent on: times 1 / (1 - 0.6).
  const double once = 0.016 * 0.6, for_ever = once / (1 - 0.6);
  for (uint32_t pass = 1; pass <= 16; ++pass) {
    for (uint32_t i = 0; i < n; ++i) {
      next[i] = 0;
      for (uint32_t j = 0; j < n; ++j) next[i] += find_factor(factors, i, j) * added[j];
      next[i] *= double{faces.reflectance[s.mesh.patches.face[i]].g};
    }
    added = next;
    for (size_t i = 0; i < n; ++i) all[i] += added[i];
    advance(s);
    const std::vector<double> expected = find_patch_polygon_means(s, faces, all);
    const std::vector<double> found =
        find_patch_polygon_means(s, faces, take_green(s.mesh.patches.radiosity));
    for (size_t k = 0; k < expected.size(); ++k) {
      CAPTURE(pass);
      CAPTURE(k);
      CHECK(std::abs(found[k] - expected[k]) <= (pass == 1 ? once : for_ever));
    }
  }
}

TEST_CASE("the matrix is the sum of its own Neumann series") {
  const FaceTable faces = make_blocked_room();
  const SolverSettings settings = make_plain_settings(64);
  const Solution run = solve_by("matrix", faces, settings);
  const Solution& s = run;
  const FactorTable factors = find_element_factors(s);
  // One more bounce of the solution is the solution. Columns are floats.
  for (uint32_t i = 0; i < s.mesh.elements.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      double received = 0;
      for (uint32_t j = 0; j < s.mesh.elements.size(); ++j)
        received += find_factor(factors, i, j) * double{s.mesh.elements.radiosity[j][k]};
      const uint32_t face = s.mesh.elements.face[i];
      const double expected = double{faces.emission[face][k]} + double{faces.reflectance[face][k]} * received;
      CHECK(double{s.mesh.elements.radiosity[i][k]} == doctest::Approx(expected).epsilon(1e-6));
    }
}

TEST_CASE("furnace, by the matrix: E = 0.5, rho = 0.5 in a closed box gives B = 1 everywhere") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1, 2, 3), make_box_surfaces(make_surface(0.5f, 0.5f)));
  fit_scene(faces);
  const Solution run = solve_by("matrix", faces, make_plain_settings(64));
  // Rows of exact factors sum to 1 within 1e-6 (contour.h), and B = 0.5 / (1 - 0.5 sum).
  for (const Rgb& radiosity : run.mesh.elements.radiosity)
    CHECK(double{radiosity.g} == doctest::Approx(1).epsilon(2e-6));
}

TEST_CASE("all solvers end at one solution") {
  const FaceTable faces = make_blocked_room();
  SolverSettings settings = make_plain_settings(1024);
  settings.until = 1e-4;
  const Solution matrix = solve_by("matrix", faces, settings),
                 shooting = solve_by("shooting", faces, settings),
                 passes = solve_by("passes", faces, settings);
  for (uint32_t polygon = 0; polygon < next_polygon(faces); ++polygon) {
    CAPTURE(polygon);
    const double expected = mean_radiosity(matrix, faces, polygon);
    // Less than 1e-4 of all that was received is unshot. Bright shots err by less than 1 / (2 sqrt(64)) of
    // the light at a shadow's edge, which few elements have, others by one ray's yes or no: 200 shooters and
    // more than 16 elements a polygon leave 1 / (2 sqrt(3200)) < 1 % at four standard errors less.
    CHECK(mean_radiosity(shooting, faces, polygon) == doctest::Approx(expected).epsilon(0.01));
    // Rows: as in the test of the series. Elements take the patches' light as a surface over them, which
    // turns off the mean of a patch at the borders of polygons by up to the square of its size, 1 %.
    CHECK(mean_radiosity(passes, faces, polygon) == doctest::Approx(expected).epsilon(0.03));
  }
}

TEST_CASE("shooting keeps the ledger: what is not absorbed and did not escape is unshot, shot by shot") {
  FaceTable faces = make_blocked_room();
  // Without its right wall the room loses light.
  FaceTable open;
  for (uint32_t f = 0; f < faces.size(); ++f)
    if (faces.polygon[f] != kRight)
      add_polygon(open, std::span(faces.corners[f]).first(faces.corner_count[f]),
                  {faces.emission[f], faces.reflectance[f]});
  const SolverSettings settings = make_plain_settings(1024);
  Solution run = make_run(open, settings);
  for (const uint32_t count : {1u, 10u, 200u, 1000u}) {
    while (run.log.passes.size() < count) advance_shot(run);
    const PowerLedger ledger = find_power_ledger(run);
    CAPTURE(count);
    // Rows of 1024 rays tell what escapes and what the shots bring; both err by a few of a thousand. A
    // single early shot weighs its own patch's row: 1 / (2 sqrt(1024)) of its share.
    CHECK(ledger.closure_error <= 0.01);
    CHECK(ledger.unshot.g > 0);
    CHECK(ledger.escaped.g > 0);
  }
}

TEST_CASE("a shot takes the largest unshot power, and leaves none there") {
  const FaceTable faces = make_blocked_room();
  const SolverSettings settings = make_plain_settings(64);
  Solution run = make_run(faces, settings);
  Solution& s = run;
  const auto power = [&](size_t p) {
    const Rgb unshot = s.mesh.patches.unshot[p];
    return double{s.mesh.patches.area[p]} * s.mesh.patches.exposed[p] *
           double{unshot.r + unshot.g + unshot.b};
  };
  for (int shot = 0; shot < 50; ++shot) {
    double most = 0;
    for (size_t p = 0; p < s.mesh.patches.size(); ++p) most = std::max(most, power(p));
    std::vector<double> before;
    for (size_t p = 0; p < s.mesh.patches.size(); ++p) before.push_back(power(p));
    const std::vector<uint32_t> shots = s.shooting ? s.shooting->shots : std::vector<uint32_t>{};
    advance_shot(s);
    for (size_t p = 0; p < s.mesh.patches.size(); ++p)
      if (s.shooting->shots[p] != (shots.empty() ? 0 : shots[p])) {
        CHECK(before[p] == doctest::Approx(most).epsilon(1e-6));
        CHECK(power(p) == 0);
      }
  }
}

TEST_CASE("the ambient term guesses the end: after few shots the picture is nearer to it") {
  const FaceTable faces = make_blocked_room();
  const SolverSettings settings = make_plain_settings(64);
  const Solution end = solve_by("matrix", faces, settings);
  const std::vector<Rgb> converged = vertex_radiosity(end);
  const auto find_error = [&](bool ambient) {
    Solution run = make_run(faces, settings);
    // Half of the ceiling.
    while (run.log.passes.size() < 30) advance_shot(run);
    const std::vector<Rgb> shown = vertex_radiosity(run, ambient ? find_ambient(run) : Rgb(0));
    double error = 0;
    for (size_t v = 0; v < shown.size(); ++v) error += double{std::abs(shown[v].g - converged[v].g)};
    return error;
  };
  CHECK(find_error(true) < 0.8 * find_error(false));
}

TEST_CASE("where light never dies the matrix has no solution, and says so") {
  FaceTable faces;
  BoxSurfaces surfaces = make_box_surfaces(make_surface(0, 1));
  surfaces[kCeiling].emission = Rgb(1);
  add_box_inward(faces, Vec3(0), Vec3(1), surfaces);
  fit_scene(faces);
  const SolverSettings settings = make_plain_settings(64);
  Solution run = make_run(faces, settings);
  CHECK_THROWS_AS(solve_matrix(run), std::domain_error);
}

TEST_CASE("shots among bright walls end where the light does: B = E / (1 - rho)") {
  for (const float reflectance : {0.5f, 0.9f, 0.97f}) {
    CAPTURE(reflectance);
    FaceTable faces;
    add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, reflectance)));
    fit_scene(faces);
    SolverSettings settings;
    settings.patch_size = settings.patch_size_min = 1;
    settings.threshold = 1;
    settings.until = 0.001;
    Solution s = solve_scene(faces, settings, 0);
    freeze(s);
    for (uint32_t shot = 0; shot < 20000 && !(shot > 0 && is_shot(s)); ++shot) advance_shot(s);
    REQUIRE(is_shot(s));
    // What is left by `until`, and the factors' own noise.
    CHECK(mean_radiosity(s, faces, 0, 6) == doctest::Approx(1 / (1 - double{reflectance})).epsilon(3e-3));
  }
}

// Facets of a few centimetres each have rows of their own: under a ball the light of the floor falls off
// quickly from facet to facet.
TEST_CASE("under a ball of small facets the passes agree with the matrix") {
  FaceTable faces;
  const Surface grey = make_surface(0, 0.6f);
  BoxSurfaces walls = make_box_surfaces(grey);
  const uint32_t room = add_box_inward(faces, Vec3(0), {2, 1, 2}, walls);
  faces.emission[room + kCeiling] = Rgb(1);
  const uint32_t first =
      add_sphere(faces, {1, 0.2f, 1}, 0.125f, 10, 20, std::acos(-1.0), false, [&](uint32_t) { return grey; });
  const uint32_t last = next_polygon(faces);
  fit_scene(faces);
  const Solution passes = solve_by("passes", faces, {});
  SolverSettings few;
  few.patch_count_max = 1200;
  const Solution matrix = solve_by("matrix", faces, few);
  double squares = 0, count = 0;
  for (uint32_t polygon = first; polygon < last; ++polygon) {
    if (faces.normal[polygon].y > -0.1f) continue;  // the lower half, which sees no lamp
    const double off = mean_radiosity(passes, faces, polygon) / mean_radiosity(matrix, faces, polygon) - 1;
    squares += off * off, ++count;
  }
  CHECK(count >= 80);
  // Means over facets of rows of 144 stratified rays, about 1 % each. One row for a part of the ball would
  // make it 2 %.
  CHECK(std::sqrt(squares / count) <= 0.01);
}
