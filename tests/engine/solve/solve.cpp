#include "engine/solve/solve.h"

#include "engine/base/parallel.h"
#include "engine/mesh/quadtree.h"
#include "engine/mesh/vertices.h"
#include "engine/solve/forecast.h"
#include "engine/solve/sizes.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <thread>

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
  return std::all_of(s.mesh.elements.radiosity.begin(), s.mesh.elements.radiosity.end(), [](Rgb b) {
    return std::isfinite(b.r) && std::isfinite(b.g) && std::isfinite(b.b) && b.r >= 0 && b.g >= 0 && b.b >= 0;
  });
}

}  // namespace

TEST_CASE("solve: rounds grow the mesh within the budget, and the mesh stays frozen through the passes") {
  const FaceTable faces = make_lit_room(10);
  SolverSettings settings;
  settings.patch_count_max = 20000;
  Solution run = solve_scene(faces, settings, 0);
  Solution& s = run;
  REQUIRE(s.log.rounds.size() >= 2);
  for (size_t k = 0; k < s.log.rounds.size(); ++k) {
    CHECK(s.log.rounds[k].round == k + 1);
    if (k > 0)
      CHECK(s.log.rounds[k].patch_count == s.log.rounds[k - 1].patch_count + 3 * s.log.rounds[k].split_count);
  }
  CHECK(s.log.rounds.back().patch_count == s.mesh.elements.size());
  CHECK(s.mesh.elements.size() <= settings.patch_count_max);
  const std::vector<uint32_t> cells = s.mesh.elements.cell;
  advance_to(run, 3);
  CHECK(s.mesh.elements.cell == cells);
  CHECK(s.mesh.frozen);
  for (uint32_t pass = 1; pass <= 3; ++pass) CHECK(s.log.passes[pass - 1].pass == pass);
}

TEST_CASE("solve: every patch is a union of elements, and neighbours differ by one level at most") {
  const FaceTable faces = make_lit_room(10);
  const Solution run = solve_scene(faces, {}, 0);
  const Solution& s = run;
  REQUIRE(s.mesh.element_first.size() == s.mesh.patches.size() + 1);
  REQUIRE(s.mesh.reasons.size() == s.mesh.elements.size());
  for (uint32_t p = 0; p < s.mesh.patches.size(); ++p) {
    double area = 0;
    for (uint32_t row = s.mesh.element_first[p]; row < s.mesh.element_first[p + 1]; ++row) {
      REQUIRE(s.mesh.element_patch[row] == p);
      area += s.mesh.elements.area[row];
    }
    REQUIRE(area == doctest::Approx(s.mesh.patches.area[p]).epsilon(1e-5));
  }
  for (const PatchTable* table : {&s.mesh.patches, &s.mesh.elements})
    for (uint32_t row = 0; row < table->size(); ++row)
      for (uint32_t edge = 0; edge < edge_count(s.surfaces->frames, table->face[row]); ++edge) {
        const uint32_t other =
            find_coarse_neighbour(*table, s.surfaces->frames, s.surfaces->links, row, edge);
        if (other != kNone) REQUIRE(table->level[row] - table->level[other] <= 1);
      }
}

TEST_CASE("solve: pass 0 is emission alone, and every pass adds what it says") {
  const FaceTable faces = make_lit_room(10);
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 0);
  Solution& s = run;
  freeze(s);
  for (size_t row = 0; row < s.mesh.elements.size(); ++row)
    REQUIRE(s.mesh.elements.radiosity[row] == faces.emission[s.mesh.elements.face[row]]);
  DRgb before = polygon_power(s, faces, 0, next_polygon(faces), s.mesh.elements.radiosity);
  double added_before = 1e30;
  for (uint32_t pass = 1; pass <= 6; ++pass) {
    advance_to(run, pass);
    const DRgb now = polygon_power(s, faces, 0, next_polygon(faces), s.mesh.elements.radiosity);
    const PassReport& report = s.log.passes.back();
    CHECK(report.added_power.g == doctest::Approx(now.g - before.g).epsilon(1e-4));
    float most = 0;
    for (const Rgb& unshot : s.mesh.elements.unshot) most = std::max(most, largest(unshot));
    CHECK(report.added_largest == most);
    // Reflectances are 0.7 at most: after the first bounce each adds less than the one before.
    if (pass > 1) CHECK(report.added_power.r <= 0.71 * added_before);
    added_before = report.added_power.r;
    before = now;
  }
  CHECK(s.log.passes[0].ray_count > 0);
  CHECK(s.log.passes[2].ray_count == 0);
}

TEST_CASE("solve: a surface without reflectance in a channel shows nothing of it") {
  const FaceTable faces = make_lit_room(10);
  const Solution run = solve_scene(faces, {}, 4);
  for (uint32_t row = 0; row < run.mesh.elements.face_first[6]; ++row)
    REQUIRE(run.mesh.elements.radiosity[row].b == 0);
  CHECK(all_finite(run));
}

TEST_CASE("solve: twice the emission gives twice the light, bit by bit") {
  const FaceTable one = make_lit_room(10), much = make_lit_room(10 * 0x1p40f),
                  little = make_lit_room(10 * 0x1p-20f);
  const Solution a = solve_scene(one, {}, 3), b = solve_scene(much, {}, 3), c = solve_scene(little, {}, 3);
  REQUIRE(a.mesh.elements.cell == b.mesh.elements.cell);
  REQUIRE(a.mesh.elements.cell == c.mesh.elements.cell);
  for (size_t row = 0; row < a.mesh.elements.size(); ++row) {
    REQUIRE(b.mesh.elements.radiosity[row] == 0x1p40f * a.mesh.elements.radiosity[row]);
    REQUIRE(c.mesh.elements.radiosity[row] == 0x1p-20f * a.mesh.elements.radiosity[row]);
  }
}

TEST_CASE("solve: it is converged once a pass adds less than the share asked of what the first added") {
  const FaceTable faces = make_lit_room(10);
  SolverSettings settings;
  settings.until = 0.01;
  Solution run = solve_scene(faces, settings, 0);
  CHECK(!is_converged(run));
  uint32_t pass = 0;
  while (!is_converged(run) && pass < 50) advance_to(run, ++pass);
  CHECK(pass > 2);
  CHECK(pass < 50);
  CHECK(run.log.passes.back().added_largest < 0.01 * run.log.passes.front().added_largest);
  run.settings.until = 0;
  CHECK(!is_converged(run));
}

TEST_CASE(
    "solve: the forecast is near the converged picture, and the surface has the light of the elements") {
  const FaceTable faces = make_lit_room(10);
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 24);
  const Solution& s = run;
  const auto vertex = vertex_radiosity(s), forecast = vertex_radiosity_forecast(s);
  REQUIRE(vertex.size() == s.mesh.element_vertices.size());
  double corner_power = 0, forecast_power = 0, power = 0;
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    const auto& c = s.mesh.element_vertices.leaf_vertex[row];
    const double area = double{s.mesh.elements.area[row]} * s.mesh.elements.exposed[row] / 4;
    for (size_t k = 0; k < 4; ++k)
      corner_power += area * vertex[c[k]].g, forecast_power += area * forecast[c[k]].g;
    power += 4 * area * s.mesh.elements.radiosity[row].g;
  }
  // The surface keeps the mean of its elements but for shadows' edges and its limits; the forecast leaves out
  // what a bounce below half a percent adds and has the noise of rows that nothing aims: a factor for an
  // exposure.
  CHECK(corner_power == doctest::Approx(power).epsilon(0.01));
  CHECK(forecast_power == doctest::Approx(power).epsilon(0.03));
}

TEST_CASE("solve: the power of element irradiance times reflectance plus emission is that of the radiosity") {
  const FaceTable faces = make_lit_room(10);
  const Solution run = solve_scene(faces, {}, 3);
  const Solution& s = run;
  std::vector<Rgb> expected = element_irradiance(s);
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    const uint32_t face = s.mesh.elements.face[row];
    expected[row] = faces.emission[face] + faces.reflectance[face] * expected[row];
  }
  const DRgb found = polygon_power(s, faces, 0, next_polygon(faces), s.mesh.elements.radiosity);
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
    const Solution run = solve_scene(faces, settings, 2);
    CHECK(count_bytes(run) <= forecast_bytes(faces, settings, count_starting_patches(faces, settings)));
    CHECK(count_starting_patches(faces, settings) <= run.log.rounds[0].patch_count);
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
  const Solution run = solve_scene(faces, settings, 0);
  for (uint32_t row = 0; row < run.mesh.elements.size(); ++row) {
    const uint32_t face = run.mesh.elements.face[row];
    const float edge = longest_edge(
        cell_corners(run.surfaces->frames, face, run.mesh.elements.cell[row], run.mesh.elements.level[row]));
    REQUIRE(edge <= (face == 1 ? 0.0101f : 0.101f));
  }
}

TEST_CASE("solve: what an author asks for bounds the patches of both meshes") {
  const FaceTable faces = make_lit_room(10);
  const float edge = longest_edge(faces.corners[0]);  // of a cube
  const auto find_smallest = [&](const Solution& run, const PatchTable& leaves, uint32_t face) {
    float smallest = 1e30f;
    for (uint32_t row = leaves.face_first[face]; row < leaves.face_first[face + 1]; ++row)
      smallest = std::min(smallest, longest_edge(cell_corners(run.surfaces->frames, face, leaves.cell[row],
                                                              leaves.level[row])));
    return smallest;
  };
  SolverSettings settings;
  SUBCASE("both sizes as large as the walls: a patch a wall") {
    settings.patch_size = settings.patch_size_min = 2 * edge;
    const Solution run = solve_scene(faces, settings, 2);
    CHECK(run.mesh.patches.size() == faces.size());
    CHECK(run.mesh.elements.size() == faces.size());
  }
  SUBCASE("a least size alone") {
    settings.patch_size_min = 0.3f * edge;
    const Solution run = solve_scene(faces, settings, 2);
    for (uint32_t face = 0; face < 6; ++face) {
      CHECK(find_smallest(run, run.mesh.patches, face) >= 0.15f * edge);
      CHECK(find_smallest(run, run.mesh.elements, face) >= 0.15f * edge);
    }
  }
  SUBCASE("a least size of one face") {
    FaceTable coarse = faces;
    coarse.patch_size_min[1] = 2 * edge;
    const Solution run = solve_scene(coarse, settings, 2);
    CHECK(find_smallest(run, run.mesh.patches, 1) == doctest::Approx(edge));
    CHECK(find_smallest(run, run.mesh.elements, 1) == doctest::Approx(edge));
    CHECK(find_smallest(run, run.mesh.patches, 0) < 0.2f * edge);
  }
  SUBCASE("a starting size: geometry does not split below it, and light does") {
    settings.patch_size = 0.5f * edge;
    uint64_t ray_count = 0;
    const auto surfaces = make_surfaces(faces);
    const PatchTable start =
        make_patches(*surfaces, {100000, 1, 1, 0, find_asked_sizes(surfaces->faces, settings)}, ray_count);
    for (uint32_t row = 0; row < start.face_first[6]; ++row) REQUIRE(start.level[row] == 1);
    const Solution run = solve_scene(faces, settings, 2);
    CHECK(run.mesh.patches.size() > start.size());
  }
  SUBCASE("no difference is larger than all there is: nothing is split") {
    settings.patch_size = 0.25f * edge;
    settings.threshold = settings.threshold_indirect = 1;
    const Solution run = solve_scene(faces, settings, 2);
    for (uint32_t row = 0; row < run.mesh.elements.face_first[6]; ++row)
      REQUIRE(run.mesh.elements.level[row] == 2);
  }
}

TEST_CASE("solve: odd scenes are solved without complaint") {
  SolverSettings settings;
  SUBCASE("nothing at all") {
    const Solution run = solve_scene({}, settings, 2);
    CHECK(run.mesh.elements.size() == 0);
    CHECK(find_power_ledger(run).closure_error == 0);
  }
  SUBCASE("one dark triangle") {
    FaceTable faces;
    add_triangle(faces, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, make_surface(0, 0.5f));
    const Solution run = solve_scene(faces, settings, 2);
    CHECK(run.log.passes[0].added_power == DRgb(0));
    CHECK(is_converged(run));
  }
  SUBCASE("one lit triangle") {
    FaceTable faces;
    add_triangle(faces, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, make_surface(3, 0.5f));
    const Solution run = solve_scene(faces, settings, 2);
    CHECK(all_finite(run));
    CHECK(mean_radiosity(run, faces, 0) == doctest::Approx(3).epsilon(1e-6));
  }
  SUBCASE("a face that lies buried whole") {
    FaceTable faces = make_lit_room(10);
    const uint32_t buried = add_quad(faces, {0.15f, 0.08f, 0.18f}, {0.15f, 0.08f, 0.2f}, {0.17f, 0.08f, 0.2f},
                                     {0.17f, 0.08f, 0.18f}, make_surface(1, 0.5f));
    const Solution run = solve_scene(faces, settings, 3);
    CHECK(all_finite(run));
    CHECK(exposed_area(run, faces, buried, buried + 1) == 0);
    CHECK(find_power_ledger(run).closure_error < 0.1);
  }
  SUBCASE("a budget of one patch") {
    settings.patch_count_max = 1;
    const FaceTable faces = make_lit_room(10);
    const Solution run = solve_scene(faces, settings, 2);
    CHECK(run.mesh.elements.size() >= faces.size());
    CHECK(all_finite(run));
  }
  SUBCASE("very long and thin faces") {
    FaceTable faces;
    add_box_inward(faces, Vec3(0), {200, 0.5f, 0.5f}, make_box_surfaces(make_surface(0.1f, 0.9f)));
    fit_scene(faces);
    settings.patch_count_max = 20000;
    const Solution run = solve_scene(faces, settings, 2);
    CHECK(all_finite(run));
    // E (1 + rho + rho^2).
    CHECK(mean_radiosity(run, faces, 0, 6) == doctest::Approx(0.271).epsilon(1e-3));
  }
  SUBCASE("reflectance of 1") {
    FaceTable faces;
    add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(1, 1)));
    fit_scene(faces);
    const Solution run = solve_scene(faces, settings, 9);
    CHECK(mean_radiosity(run, faces, 0, 6) == doctest::Approx(10).epsilon(1e-3));
  }
}

TEST_CASE("solve: a request to cancel stops it") {
  const WorkersScope scope(std::make_shared<Workers>(2));
  Solution run = solve_scene(make_lit_room(10), {}, 1);
  run.workers->request_cancel();
  CHECK_THROWS_AS(advance(run), Cancelled);
  CHECK_THROWS_AS(make_solution(run.surfaces, {}, run.workers), Cancelled);
}

TEST_CASE("solve: two solutions at once have threads of their own, and one is stopped without the other") {
  const auto surfaces = make_surfaces(make_lit_room(10));
  const auto solve = [&](std::shared_ptr<Workers> workers, std::atomic<bool>& cancelled) {
    Solution s;
    try {
      s = make_solution(surfaces, {}, std::move(workers));
      while (refine(s)) {
      }
      for (int pass = 0; pass < 5; ++pass) advance(s);
    } catch (const Cancelled&) {
      cancelled = true;
    }
    return s;
  };
  const auto one = std::make_shared<Workers>(1), two = std::make_shared<Workers>(2);
  std::atomic<bool> one_cancelled{false}, two_cancelled{false};
  Solution kept;
  std::thread first([&] { kept = solve(one, one_cancelled); });
  two->request_cancel();
  std::thread second([&] { solve(two, two_cancelled); });
  second.join();
  first.join();
  CHECK(two_cancelled);
  CHECK(!one_cancelled);
  CHECK(one->thread_count() == 1);
  CHECK(!cancel_requested());
  two->clear_cancel();
  CHECK(find_solution_hash(kept) == find_solution_hash(solve(two, two_cancelled)));
}
