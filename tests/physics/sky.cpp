// Light from infinitely far away: the sky and the sun, against closed forms.
#include "engine/base/parallel.h"
#include "engine/film/film.h"
#include "engine/solve/solvers.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <array>

using namespace patchlight;

namespace {

// A floor that looks up: width along x, depth along z, about a middle.
uint32_t add_floor(FaceTable& faces, Vec3 middle, float width, float depth, const Surface& surface) {
  const Vec3 x(width / 2, 0, 0), z(0, 0, depth / 2);
  return add_quad(faces, middle - x - z, middle - x + z, middle + x + z, middle + x - z, surface);
}

// Mean irradiance of a polygon, green, W/m2.
double mean_irradiance(const Solution& s, const FaceTable& faces, uint32_t polygon) {
  return polygon_power(s, faces, polygon, polygon + 1, element_irradiance(s)).g /
         exposed_area(s, faces, polygon, polygon + 1);
}

Sky make_sun(Vec3 direction, double degrees, float irradiance) {
  Sky sky;
  sky.sun_direction = normalize(direction);
  sky.sun_radius = static_cast<float>(degrees / 2 * std::numbers::pi / 180);
  const double sine = std::sin(double{sky.sun_radius});
  sky.sun_emission = Rgb(static_cast<float>(double{irradiance} / (sine * sine)));
  return sky;
}

const Surface kBlack{};
const Surface kWhite = make_surface(0, 0.5f);

}  // namespace

TEST_CASE("sky: a horizontal plane receives the emission of a uniform sky, a tilted one (1 + cos t) / 2") {
  for (const double angle : {0.0, 0.5, 1.2, std::numbers::pi / 2, 2.5}) {
    CAPTURE(angle);
    FaceTable faces;
    const float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    add_quad(faces, {0, 0, 0}, {0, 0, 1}, {c, s, 1}, {c, s, 0}, kWhite);
    const Solution run = solve_scene(faces, {}, 1, make_uniform_sky(Rgb(60)));
    for (const Rgb& received : element_irradiance(run))
      CHECK(std::abs(double{received.g} / 60 - (1 + std::cos(angle)) / 2) <= 1e-5);
    // A plane sends nothing to itself, and all that it reflects leaves.
    CHECK(find_power_ledger(run).closure_error <= 3e-3);
  }
}

TEST_CASE("sky: an overcast one gives 7/9 of the zenith's emission, and a wall 0.396 of that") {
  Sky sky;
  sky.zenith = Rgb(90), sky.horizon = Rgb(30);
  FaceTable faces;
  const uint32_t floor = add_floor(faces, Vec3(0), 1, 1, kBlack);
  const uint32_t wall = add_quad(faces, {3, 0, 0}, {3, 0, 1}, {3, 1, 1}, {3, 1, 0}, kBlack);
  const Solution run = solve_scene(faces, {}, 1, sky);
  const double horizontal = mean_irradiance(run, faces, floor);
  // The wall stands three lengths off and looks away from the floor: only the floor sees it, and hides some
  // of the horizon with its dark back.
  CHECK(mean_irradiance(run, faces, wall) ==
        doctest::Approx(70 * (3 / 14.0 + 4 / (7 * std::numbers::pi))).epsilon(0.02));
  CHECK(horizontal < 70);
  CHECK(horizontal > 0.95 * 70);
}

TEST_CASE("sky: the bottom of a square well sees its opening alone") {
  // A small floor below the middle of an opening of 2 x 2, one deep: four corner rectangles of 1 x 1.
  FaceTable faces;
  add_box_inward(faces, {-1, 0, -1}, {1, 1, 1}, make_box_surfaces(kBlack));
  FaceTable well;
  for (const uint32_t side : {kLeft, kRight, kFront, kBack}) {
    const auto& c = faces.corners[side];
    add_quad(well, c[0], c[1], c[2], c[3], kBlack);
  }
  const uint32_t bottom = add_floor(well, Vec3(0), 0.04f, 0.04f, kBlack);
  well.level_min[bottom] = 3;
  const double root = std::sqrt(2.0);
  const double factor = 4 / (2 * std::numbers::pi) * 2 / root * std::atan(1 / root);
  const Solution run = solve_scene(well, {}, 1, make_uniform_sky(Rgb(100)));
  // Of 64 elements with 16 rays and more to each of the groups; the mean of them errs by less than 0.5 %.
  CHECK(mean_irradiance(run, well, bottom) / 100 == doctest::Approx(factor).epsilon(0.005));
}

TEST_CASE("sky: the bottom of a round well receives the squared sine of the angle that its mouth fills") {
  constexpr uint32_t kSides = 64;
  FaceTable faces;
  const std::vector<Vec3> low = make_ring({0, 0, 0}, 1, kSides, 1), high = make_ring({0, 2, 0}, 1, kSides, 1);
  for (size_t k = 0; k < kSides; ++k) {
    const size_t next = (k + 1) % kSides;
    add_quad(faces, low[next], low[k], high[k], high[next], kBlack);
  }
  for (uint32_t f = 0; f < kSides; ++f)
    if (dot(faces.normal[f], faces.corners[f][0]) > 0) turn_face(faces, f);
  const uint32_t bottom = add_floor(faces, Vec3(0), 0.04f, 0.04f, kBlack);
  faces.level_min[kSides] = 3;
  // The walls stay coarse: what they receive is not asked for.
  SolverSettings settings;
  settings.patch_count_max = 6000;
  const Solution run = solve_scene(faces, settings, 1, make_uniform_sky(Rgb(100)));
  // 1 / (1 + 2^2); a polygon of 64 corners has 0.16 % less area than the circle.
  CHECK(mean_irradiance(run, faces, bottom) / 100 == doctest::Approx(0.2 * 0.9984).epsilon(0.008));
}

TEST_CASE("sky furnace: E = 1 - rho under a sky and a ground of 1 gives B = 1, also in an open room") {
  Sky sky = make_uniform_sky(Rgb(1));
  sky.ground = Rgb(1);
  FaceTable box;
  add_box_outward(box, Vec3(0), {1, 0.5f, 2}, make_surface(0.2f, 0.8f));
  Solution run = solve_scene(box, {}, 2, sky);
  for (const Rgb& radiosity : run.mesh.elements.radiosity) CHECK(std::abs(radiosity.g - 1) <= 1e-5f);

  FaceTable closed, open;
  add_box_inward(closed, Vec3(0), {1, 1, 2}, make_box_surfaces(make_surface(0.3f, 0.7f)));
  for (uint32_t f = 0; f < closed.size(); ++f) {
    const auto& c = closed.corners[f];
    if (f != kRight) add_quad(open, c[0], c[1], c[2], c[3], make_surface(0.3f, 0.7f));
  }
  run = solve_scene(open, {}, 30, sky);
  for (uint32_t polygon = 0; polygon < next_polygon(open); ++polygon)
    CHECK(mean_radiosity(run, open, polygon) == doctest::Approx(1).epsilon(5e-3));
  CHECK(find_power_ledger(run).closure_error <= 3e-3);
}

TEST_CASE("sun: a surface receives its irradiance times the cosine") {
  for (const double elevation : {90.0, 60.0, 20.0, 3.0}) {
    CAPTURE(elevation);
    const double angle = elevation * std::numbers::pi / 180;
    const Sky sky = make_sun(Vec3(DVec3(std::cos(angle), std::sin(angle), 0)), 0.53, 800);
    FaceTable faces;
    add_floor(faces, Vec3(0), 1, 1, kWhite);
    const Solution run = solve_scene(faces, {}, 1, sky);
    for (const Rgb& received : element_irradiance(run))
      CHECK(received.g == doctest::Approx(800 * std::sin(angle)).epsilon(1e-5));
    CHECK(find_power_ledger(run).closure_error <= 1e-3);
  }
}

TEST_CASE("sun: the edge of a shadow is as wide as its distance times the sun's angle") {
  // A screen half a length over the floor ends at x = 0; the sun is overhead and 4 degrees wide.
  constexpr float kHeight = 0.5f;
  const Sky sky = make_sun({0, 1, 0}, 4, 100);
  FaceTable faces;
  const uint32_t floor = add_floor(faces, Vec3(0), 0.4f, 0.4f, kWhite);
  add_floor(faces, {-1, kHeight, 0}, 2, 4, kBlack);
  const Solution run = solve_scene(faces, {.patch_size_min = 0.002f}, 1, sky);
  const double half_width = kHeight * std::tan(2 * std::numbers::pi / 180);
  double worst = 0, sum = 0, count = 0;
  const std::vector<Rgb> received = element_irradiance(run);
  for (uint32_t row = 0; row < run.mesh.elements.size(); ++row) {
    const PatchTable& elements = run.mesh.elements;
    if (faces.polygon[elements.face[row]] != floor) continue;
    const double x = double{
        cell_centre(run.surfaces->frames, elements.face[row], elements.cell[row], elements.level[row]).x};
    const double edge = double{longest_edge(
        cell_corners(run.surfaces->frames, elements.face[row], elements.cell[row], elements.level[row]))};
    // The share of a disc beyond a chord.
    const double t = std::clamp(-x / half_width, -1.0, 1.0);
    const double share = (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi;
    const double error = double{received[row].g} / 100 - share;
    if (std::abs(x) > half_width + edge) worst = std::max(worst, std::abs(error));
    if (std::abs(x) < half_width && edge < half_width) sum += error * error, ++count;
  }
  CHECK(worst <= 1e-5);
  REQUIRE(count > 500);
  // 64 pairs in strata, worth about 3 x 64: 0.5 / sqrt(192) where half is seen.
  CHECK(std::sqrt(sum / count) <= 0.036);
}

TEST_CASE("sky: a room with a window is lit as by a lamp that fills the window") {
  const auto make_room = [](bool with_panel) {
    FaceTable faces;
    FaceTable closed;
    add_box_inward(closed, Vec3(0), {1, 0.6f, 1}, make_box_surfaces(make_surface(0, 0.6f)));
    for (uint32_t f = 0; f < closed.size(); ++f) {
      const auto& c = closed.corners[f];
      if (f != kRight) add_quad(faces, c[0], c[1], c[2], c[3], make_surface(0, 0.6f));
    }
    // The wall on the right has a window, 0.4 wide and 0.3 high.
    const auto add_wall = [&](float y0, float y1, float z0, float z1) {
      add_quad(faces, {1, y0, z0}, {1, y0, z1}, {1, y1, z1}, {1, y1, z0}, make_surface(0, 0.6f));
    };
    add_wall(0, 0.2f, 0, 1), add_wall(0.5f, 0.6f, 0, 1);
    add_wall(0.2f, 0.5f, 0, 0.3f), add_wall(0.2f, 0.5f, 0.7f, 1);
    if (with_panel)
      add_quad(faces, {1, 0.2f, 0.3f}, {1, 0.2f, 0.7f}, {1, 0.5f, 0.7f}, {1, 0.5f, 0.3f},
               make_surface(50, 0));
    return faces;
  };
  Sky sky = make_uniform_sky(Rgb(50));
  sky.ground = Rgb(50);
  const FaceTable with_sky = make_room(false), with_panel = make_room(true);
  const SolverSettings settings{.patch_size_min = 0.01f};
  const Solution a = solve_scene(with_sky, settings, 12, sky), b = solve_scene(with_panel, settings, 12);
  for (const uint32_t polygon : {0u, 1u, 2u, 3u, 4u}) {
    CAPTURE(polygon);
    CHECK(mean_radiosity(a, with_sky, polygon) ==
          doctest::Approx(mean_radiosity(b, with_panel, polygon)).epsilon(0.02));
  }
  CHECK(find_power_ledger(a).closure_error <= 3e-3);
}

TEST_CASE("sky: all solvers give the same light") {
  FaceTable faces;
  const uint32_t floor = add_floor(faces, Vec3(0), 2, 2, kWhite);
  add_quad(faces, {-1, 0, -1}, {1, 0, -1}, {1, 1, -1}, {-1, 1, -1}, kWhite);
  add_quad(faces, {0.5f, 0.8f, -0.6f}, {0.8f, 0.8f, -0.6f}, {0.8f, 0.8f, -0.9f}, {0.5f, 0.8f, -0.9f},
           make_surface(20, 0));
  Sky sky = make_overcast_sky(Rgb(30));
  sky.sun_direction = normalize(Vec3(0.3f, 1, 0.5f)), sky.sun_radius = 0.01f;
  sky.sun_emission = Rgb(80 / 1e-4f);
  std::vector<double> means;
  for (const Solver& solver : solvers()) {
    CAPTURE(solver.name);
    Solution run =
        solve_scene(faces, {.until = 1e-4, .patch_size_min = 0.1f, .patch_count_max = 800}, 0, sky);
    freeze(run);
    do solver.advance(run);
    while (!solver.is_converged(run) && run.log.passes.size() < 20000);
    means.push_back(mean_radiosity(run, faces, floor));
    CHECK(find_power_ledger(run).closure_error <= 3e-3);
    CHECK(means.back() == doctest::Approx(means.front()).epsilon(0.005));
  }
}

TEST_CASE("sky: the same bits at any number of threads, kept or cast again") {
  FaceTable faces;
  add_floor(faces, Vec3(0), 2, 2, kWhite);
  add_box_outward(faces, {-0.3f, 0.01f, -0.3f}, {0.3f, 0.5f, 0.3f}, kWhite);
  Sky sky = make_clear_sky(3, normalize(DVec3(0.5, 0.6, 0.2)), Rgb(60));
  sky.ground = Rgb(5);
  const Sky sun = make_sun({0.5f, 0.6f, 0.2f}, 0.53, 400);
  sky.sun_direction = sun.sun_direction, sky.sun_radius = sun.sun_radius, sky.sun_emission = sun.sun_emission;
  const auto find_hash = [&](size_t threads, bool keep) {
    const WorkersScope scope(std::make_shared<Workers>(threads));
    return find_solution_hash(
        solve_scene(faces, {.patch_count_max = 3000, .rays = 64, .keep_rows = keep}, 3, sky));
  };
  const uint64_t hash = find_hash(1, true);
  CHECK(find_hash(2, true) == hash);
  CHECK(find_hash(5, true) == hash);
  CHECK(find_hash(2, false) == hash);
}
