#include "engine/solve.h"

#include "engine/parallel.h"
#include "engine/quadtree.h"
#include "engine/vertices.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace patchlight;

namespace {

FaceTable make_lit_room(float emission) {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces({Rgb(0), Rgb(0.7f, 0.5f, 0)}));
  add_quad(faces, {0.35f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.6f}, {0.35f, 0.98f, 0.6f},
           make_surface(emission, 0.3f));
  add_box_outward(faces, {0.2f, -0.01f, 0.3f}, {0.5f, 0.45f, 0.6f}, make_surface(0, 0.6f));
  fit_scene(faces);
  return faces;
}

bool all_finite(const Solution& s) {
  return std::all_of(s.elements.radiosity.begin(), s.elements.radiosity.end(), [](Rgb b) {
    return std::isfinite(b.r) && std::isfinite(b.g) && std::isfinite(b.b) && b.r >= 0 && b.g >= 0 && b.b >= 0;
  });
}

}  // namespace

TEST_CASE("solve: rounds grow the mesh within the budget, and the mesh stays frozen through the passes") {
  const FaceTable faces = make_lit_room(10);
  SolverSettings settings;
  settings.patch_count_max = 20000;
  Run run = run_scene(faces, settings, 0);
  Solution& s = run.solution;
  REQUIRE(s.rounds.size() >= 2);
  for (size_t k = 0; k < s.rounds.size(); ++k) {
    CHECK(s.rounds[k].round == k + 1);
    if (k > 0) CHECK(s.rounds[k].patch_count == s.rounds[k - 1].patch_count + 3 * s.rounds[k].split_count);
  }
  CHECK(s.rounds.back().patch_count == s.elements.size());
  CHECK(s.elements.size() <= settings.patch_count_max);
  const std::vector<uint32_t> cells = s.elements.cell;
  advance_to(run, faces, settings, 3);
  CHECK(s.elements.cell == cells);
  CHECK(s.frozen);
  for (uint32_t pass = 1; pass <= 3; ++pass) CHECK(s.passes[pass - 1].pass == pass);
}

TEST_CASE("solve: every patch is a union of elements, and neighbours differ by one level at most") {
  const FaceTable faces = make_lit_room(10);
  const Run run = run_scene(faces, {}, 0);
  const Solution& s = run.solution;
  REQUIRE(s.element_first.size() == s.patches.size() + 1);
  REQUIRE(s.reasons.size() == s.elements.size());
  for (uint32_t p = 0; p < s.patches.size(); ++p) {
    double area = 0;
    for (uint32_t row = s.element_first[p]; row < s.element_first[p + 1]; ++row) {
      REQUIRE(s.element_patch[row] == p);
      area += s.elements.area[row];
    }
    REQUIRE(area == doctest::Approx(s.patches.area[p]).epsilon(1e-5));
  }
  for (const PatchTable* table : {&s.patches, &s.elements})
    for (uint32_t row = 0; row < table->size(); ++row)
      for (uint32_t edge = 0; edge < edge_count(s.frames, table->face[row]); ++edge) {
        const uint32_t other = find_coarse_neighbour(*table, s.frames, s.links, row, edge);
        if (other != kNone) REQUIRE(table->level[row] - table->level[other] <= 1);
      }
}

TEST_CASE("solve: pass 0 is emission alone, and every pass adds what it says") {
  const FaceTable faces = make_lit_room(10);
  const SolverSettings settings;
  Run run = run_scene(faces, settings, 0);
  Solution& s = run.solution;
  freeze(s, faces, run.tracer, settings);
  for (size_t row = 0; row < s.elements.size(); ++row)
    REQUIRE(s.elements.radiosity[row] == faces.emission[s.elements.face[row]]);
  DRgb before = polygon_power(s, faces, 0, next_polygon(faces), s.elements.radiosity);
  double added_before = 1e30;
  for (uint32_t pass = 1; pass <= 6; ++pass) {
    advance_to(run, faces, settings, pass);
    const DRgb now = polygon_power(s, faces, 0, next_polygon(faces), s.elements.radiosity);
    const PassReport& report = s.passes.back();
    CHECK(report.added_power.g == doctest::Approx(now.g - before.g).epsilon(1e-4));
    float most = 0;
    for (const Rgb& unshot : s.elements.unshot) most = std::max(most, largest(unshot));
    CHECK(report.added_largest == most);
    // Reflectances are 0.7 at most: after the first bounce each adds less than the one before.
    if (pass > 1) CHECK(report.added_power.r <= 0.71 * added_before);
    added_before = report.added_power.r;
    before = now;
  }
  CHECK(s.passes[0].ray_count > 0);
  CHECK(s.passes[2].ray_count == 0);
}

TEST_CASE("solve: a surface without reflectance in a channel shows nothing of it") {
  const FaceTable faces = make_lit_room(10);
  const Run run = run_scene(faces, {}, 4);
  for (uint32_t row = 0; row < run.solution.elements.face_first[6]; ++row)
    REQUIRE(run.solution.elements.radiosity[row].b == 0);
  CHECK(all_finite(run.solution));
}

TEST_CASE("solve: twice the emission gives twice the light, bit by bit") {
  const FaceTable one = make_lit_room(10), much = make_lit_room(10 * 0x1p40f),
                  little = make_lit_room(10 * 0x1p-20f);
  const Run a = run_scene(one, {}, 3), b = run_scene(much, {}, 3), c = run_scene(little, {}, 3);
  REQUIRE(a.solution.elements.cell == b.solution.elements.cell);
  REQUIRE(a.solution.elements.cell == c.solution.elements.cell);
  for (size_t row = 0; row < a.solution.elements.size(); ++row) {
    REQUIRE(b.solution.elements.radiosity[row] == 0x1p40f * a.solution.elements.radiosity[row]);
    REQUIRE(c.solution.elements.radiosity[row] == 0x1p-20f * a.solution.elements.radiosity[row]);
  }
}

TEST_CASE("solve: it is converged once a pass adds less than the share asked of what the first added") {
  const FaceTable faces = make_lit_room(10);
  SolverSettings settings;
  settings.until = 0.01;
  Run run = run_scene(faces, settings, 0);
  CHECK(!is_converged(run.solution, settings));
  uint32_t pass = 0;
  while (!is_converged(run.solution, settings) && pass < 50) advance_to(run, faces, settings, ++pass);
  CHECK(pass > 2);
  CHECK(pass < 50);
  CHECK(run.solution.passes.back().added_largest < 0.01 * run.solution.passes.front().added_largest);
  settings.until = 0;
  CHECK(!is_converged(run.solution, settings));
}

TEST_CASE(
    "solve: the forecast is near the converged picture, and the surface has the light of the elements") {
  const FaceTable faces = make_lit_room(10);
  const SolverSettings settings;
  Run run = run_scene(faces, settings, 24);
  const Solution& s = run.solution;
  const auto vertex = vertex_radiosity(s, faces), forecast = vertex_radiosity_forecast(s, faces);
  REQUIRE(vertex.size() == s.element_vertices.size());
  double corner_power = 0, forecast_power = 0, power = 0;
  for (size_t row = 0; row < s.elements.size(); ++row) {
    const auto& c = s.element_vertices.leaf_vertex[row];
    const double area = double{s.elements.area[row]} * s.elements.exposed[row] / 4;
    for (size_t k = 0; k < 4; ++k)
      corner_power += area * vertex[c[k]].g, forecast_power += area * forecast[c[k]].g;
    power += 4 * area * s.elements.radiosity[row].g;
  }
  // The surface keeps the mean of its elements but for shadows' edges and its limits; the forecast leaves out
  // what a bounce below half a percent adds and has the noise of rows that nothing aims: a factor for an
  // exposure.
  CHECK(corner_power == doctest::Approx(power).epsilon(0.01));
  CHECK(forecast_power == doctest::Approx(power).epsilon(0.03));
}

TEST_CASE("solve: the power of element irradiance times reflectance plus emission is that of the radiosity") {
  const FaceTable faces = make_lit_room(10);
  const Run run = run_scene(faces, {}, 3);
  const Solution& s = run.solution;
  std::vector<Rgb> expected = element_irradiance(s);
  for (size_t row = 0; row < s.elements.size(); ++row) {
    const uint32_t face = s.elements.face[row];
    expected[row] = faces.emission[face] + faces.reflectance[face] * expected[row];
  }
  const DRgb found = polygon_power(s, faces, 0, next_polygon(faces), s.elements.radiosity);
  const DRgb power = polygon_power(s, faces, 0, next_polygon(faces), expected);
  // The limits of the surface at borders make the sum of three surfaces another than the surface of the sum;
  // the ledger mixes both and must close within 3e-3.
  for (int k = 0; k < 3; ++k) CHECK(std::abs(found[k] - power[k]) <= 3e-3 * power[k]);
}

TEST_CASE("solve: tables stay within the forecast of bytes, and starting patches within their count") {
  for (const uint64_t budget : {2000ull, 20000ull, 200000ull}) {
    const FaceTable faces = make_lit_room(10);
    SolverSettings settings;
    settings.patch_count_max = budget;
    const Run run = run_scene(faces, settings, 2);
    CHECK(count_bytes(run.solution) <=
          forecast_bytes(faces, settings, count_starting_patches(faces, settings)));
    CHECK(count_starting_patches(faces, settings) <= run.solution.rounds[0].patch_count);
  }
}

TEST_CASE("solve: a starting size is kept, by face and for all") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, make_surface(0, 0.5f));
  add_quad(faces, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, make_surface(0, 0.5f));
  fit_scene(faces);
  faces.patch_size[1] = 0.01f;
  SolverSettings settings;
  settings.patch_size = 0.1f;
  const Run run = run_scene(faces, settings, 0);
  for (uint32_t row = 0; row < run.solution.elements.size(); ++row) {
    const uint32_t face = run.solution.elements.face[row];
    const float edge = longest_edge(cell_corners(run.solution.frames, face, run.solution.elements.cell[row],
                                                 run.solution.elements.level[row]));
    REQUIRE(edge <= (face == 1 ? 0.0101f : 0.101f));
  }
}

TEST_CASE("solve: odd scenes are solved without complaint") {
  SolverSettings settings;
  SUBCASE("nothing at all") {
    const Run run = run_scene({}, settings, 2);
    CHECK(run.solution.elements.size() == 0);
    CHECK(find_power_ledger(run.solution, {}, run.tracer, settings).closure_error == 0);
  }
  SUBCASE("one dark triangle") {
    FaceTable faces;
    add_triangle(faces, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, make_surface(0, 0.5f));
    const Run run = run_scene(faces, settings, 2);
    CHECK(run.solution.passes[0].added_power == DRgb(0));
    CHECK(is_converged(run.solution, settings));
  }
  SUBCASE("one lit triangle") {
    FaceTable faces;
    add_triangle(faces, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, make_surface(3, 0.5f));
    const Run run = run_scene(faces, settings, 2);
    CHECK(all_finite(run.solution));
    CHECK(mean_radiosity(run.solution, faces, 0) == doctest::Approx(3).epsilon(1e-6));
  }
  SUBCASE("a face that lies buried whole") {
    FaceTable faces = make_lit_room(10);
    const uint32_t buried = add_quad(faces, {0.15f, 0.08f, 0.18f}, {0.15f, 0.08f, 0.2f}, {0.17f, 0.08f, 0.2f},
                                     {0.17f, 0.08f, 0.18f}, make_surface(1, 0.5f));
    const Run run = run_scene(faces, settings, 3);
    CHECK(all_finite(run.solution));
    CHECK(exposed_area(run.solution, faces, buried, buried + 1) == 0);
    CHECK(find_power_ledger(run.solution, faces, run.tracer, settings).closure_error < 0.1);
  }
  SUBCASE("a budget of one patch") {
    settings.patch_count_max = 1;
    const FaceTable faces = make_lit_room(10);
    const Run run = run_scene(faces, settings, 2);
    CHECK(run.solution.elements.size() >= faces.size());
    CHECK(all_finite(run.solution));
  }
  SUBCASE("very long and thin faces") {
    FaceTable faces;
    add_box_inward(faces, Vec3(0), {200, 0.5f, 0.5f}, make_box_surfaces(make_surface(0.1f, 0.9f)));
    fit_scene(faces);
    settings.patch_count_max = 20000;
    const Run run = run_scene(faces, settings, 2);
    CHECK(all_finite(run.solution));
    // E (1 + rho + rho^2).
    CHECK(mean_radiosity(run.solution, faces, 0, 6) == doctest::Approx(0.271).epsilon(1e-3));
  }
  SUBCASE("reflectance of 1") {
    FaceTable faces;
    add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 1)));
    fit_scene(faces);
    const Run run = run_scene(faces, settings, 9);
    CHECK(mean_radiosity(run.solution, faces, 0, 6) == doctest::Approx(10).epsilon(1e-3));
  }
}

TEST_CASE("solve: a request to cancel stops it") {
  const FaceTable faces = make_lit_room(10);
  Run run = run_scene(faces, {}, 1);
  request_cancel();
  CHECK_THROWS_AS(advance(run.solution, faces, run.tracer, {}), Cancelled);
  CHECK_THROWS_AS(make_solution(faces, run.tracer, {}), Cancelled);
  clear_cancel();
}
