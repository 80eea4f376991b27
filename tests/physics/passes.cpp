// Passes against other ways to the same answer: a dense solution, symmetry, other seeds, other threads, other
// places.
#include "engine/base/parallel.h"
#include "engine/solve/forecast.h"
#include "engine/solve/sizes.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace patchlight;

namespace {

FaceTable make_lit_room() {
  FaceTable faces;
  BoxSurfaces surfaces = make_box_surfaces({Rgb(0), Rgb(0.7f, 0.6f, 0.5f)});
  surfaces[kLeft].reflectance = Rgb(0.6f, 0.1f, 0.1f);
  add_box_inward(faces, Vec3(0), Vec3(1), surfaces);
  add_quad(faces, {0.4f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.6f}, {0.4f, 0.98f, 0.6f},
           make_surface(20, 0));
  add_box_outward(faces, {0.2f, 0, 0.3f}, {0.5f, 0.45f, 0.6f}, make_surface(0, 0.6f));
  fit_scene(faces);
  return faces;
}

// A mesh small enough to be made many times.
SolverSettings make_settings(uint64_t seed) {
  SolverSettings settings;
  settings.seed = seed;
  settings.patch_count_max = 10000;
  return settings;
}

// Power of each polygon after a pass.
std::vector<double> find_powers(const FaceTable& faces, const SolverSettings& settings, uint32_t pass) {
  const Solution run = solve_scene(faces, settings, pass);
  std::vector<double> powers;
  for (uint32_t polygon = 0; polygon < next_polygon(faces); ++polygon)
    powers.push_back(polygon_power(run, faces, polygon, polygon + 1, run.mesh.elements.radiosity).g);
  return powers;
}

}  // namespace

TEST_CASE("passes are the Neumann series: they tend to the dense solution of the row matrix") {
  FaceTable faces;
  BoxSurfaces surfaces;
  for (uint32_t k = 0; k < 6; ++k)
    surfaces[k] = make_surface(k == kFloor || k == kLeft ? 1.0f : 0.2f, 0.2f + 0.1f * static_cast<float>(k));
  add_box_inward(faces, Vec3(0), Vec3(1), surfaces);
  fit_scene(faces);
  SolverSettings settings;
  settings.patch_count_max = 400;
  Solution run = solve_scene(faces, settings, 40);
  const Solution& s = run;
  const size_t n = s.mesh.patches.size();
  CHECK(n < 400);
  // (I - rho F) B = E with F_ij = the share of row i's rays that end on patch j, by elimination with pivots
  // on the diagonal: the matrix is diagonally dominant.
  std::vector<std::vector<double>> matrix(n, std::vector<double>(n + 1, 0));
  for (size_t i = 0; i < n; ++i) {
    const uint32_t face = s.mesh.patches.face[i];
    for (uint32_t k = 0; k < s.transport.hits.ray_count; ++k) {
      const uint32_t j =
          s.transport.hits
              .patch[s.transport.receivers.receiver_of[i] * size_t{s.transport.hits.ray_count} + k];
      REQUIRE(j < n);
      matrix[i][j] -= double{faces.reflectance[face].g} / s.transport.hits.ray_count;
    }
    matrix[i][i] += 1;
    matrix[i][n] = faces.emission[face].g;
  }
  for (size_t k = 0; k < n; ++k)
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = matrix[i][k] / matrix[k][k];
      if (factor == 0) continue;
      for (size_t j = k; j <= n; ++j) matrix[i][j] -= factor * matrix[k][j];
    }
  std::vector<double> dense(n);
  for (size_t i = n; i-- > 0;) {
    double sum = matrix[i][n];
    for (size_t j = i + 1; j < n; ++j) sum -= matrix[i][j] * dense[j];
    dense[i] = sum / matrix[i][i];
  }
  double found = 0, expected = 0;
  for (size_t p = 0; p < n; ++p) {
    found += double{s.mesh.patches.area[p]} * s.mesh.patches.radiosity[p].g;
    expected += double{s.mesh.patches.area[p]} * dense[p];
  }
  // The dense solution knows one value a patch, the solver a surface in passes 1 and 2, and both have the
  // same rows: the means of a cube of m patches an edge differ by its constant patches' error, which falls as
  // m^-1.75 from 0.014 at m = 1 (six patches against the continuous means), here m >= 4.
  CHECK(std::abs(found / expected - 1) <= 0.014 * std::pow(4, -1.75) + 1e-3);
}

TEST_CASE("pass 1 is black where no lamp is seen, and pass 2 is not") {
  // A partition from floor to ceiling, open at one end, hides the lamp from the far half of the room.
  FaceTable faces;
  add_box_inward(faces, Vec3(0), {2, 1, 1}, make_box_surfaces(make_surface(0, 0.7f)));
  add_quad(faces, {0.05f, 0.5f, 0.05f}, {0.05f, 0.6f, 0.05f}, {0.05f, 0.6f, 0.15f}, {0.05f, 0.5f, 0.15f},
           make_surface(50, 0));
  const uint32_t partition =
      add_two_sided(faces, std::array{Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 0.9f), Vec3(1, 0, 0.9f)},
                    make_surface(0, 0.7f), make_surface(0, 0.7f));
  fit_scene(faces);
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 1);
  // At floor level, all is dark behind the partition below the line from the lamp's far edge (0.05, 0.15)
  // through the partition's free edge (1, 0.9); the same holds at every height.
  const auto scale = static_cast<float>(1 / std::sqrt(2 * (2 + 2 + 1) + 0.01 + 2 * 0.9));
  size_t dark = 0;
  const auto is_dark_place = [&](size_t row) {
    const auto corners = cell_corners(run.surfaces->frames, run.mesh.elements.face[row],
                                      run.mesh.elements.cell[row], run.mesh.elements.level[row]);
    return std::all_of(corners.begin(), corners.end(), [&](Vec3 p) {
      p /= scale;
      return p.x > 1.001f && p.z < 0.9f + (p.x - 1) * (0.9f - 0.15f) / 0.95f - 0.02f;
    });
  };
  for (size_t row = 0; row < run.mesh.elements.size(); ++row)
    if (is_dark_place(row)) {
      ++dark;
      REQUIRE(run.mesh.elements.radiosity[row] == Rgb(0));
    }
  CHECK(dark > 500);
  // Which of the partition's sides looks where.
  for (const uint32_t side : {partition, partition + 1}) {
    const bool far_side = faces.normal[side].x > 0;
    CHECK((mean_radiosity(run, faces, side) > 0) == !far_side);
  }
  advance_to(run, 2);
  double power = 0;
  for (size_t row = 0; row < run.mesh.elements.size(); ++row)
    if (is_dark_place(row)) power += double{run.mesh.elements.area[row]} * run.mesh.elements.radiosity[row].g;
  CHECK(power > 0);
}

TEST_CASE("a symmetric scene has symmetric light, within the noise that other seeds show") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces(make_surface(0, 0.6f)));
  add_quad(faces, {0.4f, 0.98f, 0.3f}, {0.6f, 0.98f, 0.3f}, {0.6f, 0.98f, 0.5f}, {0.4f, 0.98f, 0.5f},
           make_surface(20, 0));
  add_box_outward(faces, {0.1f, 0, 0.4f}, {0.25f, 0.5f, 0.6f}, make_surface(0, 0.5f));
  add_box_outward(faces, {0.75f, 0, 0.4f}, {0.9f, 0.5f, 0.6f}, make_surface(0, 0.5f));
  fit_scene(faces);
  constexpr uint32_t kSeeds = 4;
  std::array<double, kSeeds> difference{};
  double sum = 0, squares = 0;
  for (uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Solution run = solve_scene(faces, make_settings(seed + 1), 3);
    // Left against right.
    difference[seed] = mean_radiosity(run, faces, kLeft) / mean_radiosity(run, faces, kRight) - 1;
    sum += difference[seed] / kSeeds;
    squares += difference[seed] * difference[seed] / kSeeds;
  }
  // Four draws of a difference whose mean is zero: the mean stays within four of its standard errors, and the
  // scatter within what the project allows for means.
  CHECK(std::abs(sum) <= 4 * std::sqrt(squares / kSeeds));
  CHECK(std::sqrt(squares) <= 2e-3);
}

TEST_CASE("one seed gives one solution, bit by bit, at 1, 2, 3 and 8 threads") {
  const FaceTable faces = make_lit_room();
  std::vector<uint64_t> hashes;
  std::vector<size_t> sizes;
  std::vector<double> closures;
  for (const size_t threads : {1, 2, 3, 8}) {
    const WorkersScope scope(std::make_shared<Workers>(threads));
    const Solution run = solve_scene(faces, make_settings(1), 3);
    hashes.push_back(find_solution_hash(run));
    sizes.push_back(run.mesh.elements.size());
    closures.push_back(find_power_ledger(run).closure_error);
  }
  for (size_t k = 1; k < hashes.size(); ++k) {
    CHECK(hashes[k] == hashes[0]);
    CHECK(sizes[k] == sizes[0]);
    CHECK(closures[k] == closures[0]);
  }
}

TEST_CASE(
    "form factors that are computed again in every pass give the same bits as kept ones, in less memory") {
  const FaceTable faces = make_lit_room();
  SolverSettings settings = make_settings(1);
  const Solution kept = solve_scene(faces, settings, 4);
  const uint64_t forecast = forecast_bytes(faces, settings, count_starting_patches(faces, settings));
  settings.keep_rows = false;
  const Solution again = solve_scene(faces, settings, 4);
  CHECK(find_solution_hash(again) == find_solution_hash(kept));
  CHECK(find_power_ledger(again).closure_error == find_power_ledger(kept).closure_error);
  // A patch and a cell, four bytes each, a ray.
  const uint64_t row_bytes = 8 * uint64_t{kept.transport.hits.ray_count} * kept.transport.receivers.size();
  CHECK(count_bytes(kept) - count_bytes(again) >= row_bytes);
  CHECK(forecast - forecast_bytes(faces, settings, count_starting_patches(faces, settings)) >= row_bytes);
}

TEST_CASE("different seeds differ in the bits and agree within what is promised for means") {
  const FaceTable faces = make_lit_room();
  const SolverSettings one = make_settings(1), other = make_settings(2);
  CHECK(find_solution_hash(solve_scene(faces, one, 2)) != find_solution_hash(solve_scene(faces, other, 2)));
  const auto a = find_powers(faces, one, 4), b = find_powers(faces, other, 4);
  double all = 0, difference = 0;
  for (size_t k = 0; k < a.size(); ++k) all += a[k], difference += std::abs(a[k] - b[k]);
  // 2e-3 for each of the two.
  CHECK(difference <= 4e-3 * all);
}

TEST_CASE("the ledger closes better with more rays") {
  const FaceTable faces = make_lit_room();
  constexpr uint32_t kSeeds = 3;
  double squares[2] = {0, 0};
  for (int many = 0; many < 2; ++many)
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SolverSettings settings = make_settings(seed);
      settings.rays = many ? 1024 : 16;
      const Solution run = solve_scene(faces, settings, 8);
      const double error = find_power_ledger(run).closure_error;
      squares[many] += error * error / kSeeds;
    }
  // At 256 rays 3e-3 is promised; half as much noise at four times the rays, four times as much at a
  // sixteenth.
  CHECK(std::sqrt(squares[1]) <= 3e-3 / 2);
  CHECK(std::sqrt(squares[0]) <= 3e-3 * 4);
  CHECK(squares[1] < squares[0]);
}

TEST_CASE("a scene that is moved, or made smaller or larger, keeps its light") {
  const FaceTable faces = make_lit_room();
  const auto expected = find_powers(faces, make_settings(1), 3);
  double all = 0;
  for (const double power : expected) all += power;
  struct Place {
    float scale;
    Vec3 shift;
  };
  for (const Place& place : {Place{1, {3, -2, 1}}, Place{1e-3f, Vec3(0)}, Place{1e3f, Vec3(0)}}) {
    CAPTURE(place.scale);
    FaceTable moved = faces;
    map_scene(moved, place.scale, place.shift);
    // Powers in the lengths of the first.
    const auto found = find_powers(moved, make_settings(1), 3);
    double difference = 0;
    for (size_t k = 0; k < found.size(); ++k)
      difference += std::abs(found[k] / place.scale / place.scale - expected[k]);
    // Two seeds' worth of noise; ray offsets of 5e-7 in a room of 4e-4 hide another 1e-3 of it at edges.
    CHECK(difference <= (place.scale == 1e-3f ? 6e-3 : 4e-3) * all);
  }
}

TEST_CASE("the solver's answer does not depend on how a polygon is cut into faces") {
  FaceTable whole, cut;
  BoxSurfaces surfaces = make_box_surfaces(make_surface(0, 0.6f));
  surfaces[kCeiling].emission = Rgb(1);
  add_box_inward(whole, Vec3(0), Vec3(1), surfaces);
  for (uint32_t f = 0; f < whole.size(); ++f) {
    const auto& c = whole.corners[f];
    const Surface surface{whole.emission[f], whole.reflectance[f]};
    add_face(cut, std::array{c[0], c[1], c[2]}, f, surface);
    add_face(cut, std::array{c[2], c[3], c[0]}, f, surface);
  }
  fit_scene(whole), fit_scene(cut);
  const auto a = find_powers(whole, make_settings(1), 4), b = find_powers(cut, make_settings(1), 4);
  // Both are right within 2e-3 of a mean; powers are a sixth of it.
  for (size_t k = 0; k < a.size(); ++k) CHECK(std::abs(a[k] - b[k]) <= 2 * 2e-3 / 6);
}
