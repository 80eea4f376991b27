// Rooms in which the form factors matter and the answer is known.
#include "engine/light/lambert.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace patchlight;

namespace {

// What the project promises for area means of these rooms.
constexpr double kMeanError = 2e-3;

}  // namespace

// Floor, ceiling and wall. Pass 1: Howell C-11 and C-14; pass 2: integrals of squared Lambert factors; pass
// 16: a Galerkin solution on 64 x 64 x 6 closed-form factors, extrapolated, within 2e-6.
TEST_CASE("a cube whose floor emits has the known area means after passes 1, 2 and 16") {
  struct Expected {
    float rho;
    std::array<std::array<double, 3>, 3> means;
  };
  constexpr std::array<Expected, 2> kExpected = {{{0.5f,
                                                   {{{1.0, 0.0999124478491935, 0.10002188803770162},
                                                     {1.0639377255, 0.1292629496, 0.1391998312},
                                                     {1.1043589, 0.1712134, 0.1811031}}}},
                                                  {0.8f,
                                                   {{{1.0, 0.1598599165587096, 0.16003502086032262},
                                                     {1.1636805772, 0.2349972009, 0.2603305555},
                                                     {1.5687392, 0.6422142, 0.6691143}}}}}};
  constexpr std::array<uint32_t, 3> kPasses = {1, 2, 16};
  for (const Expected& expected : kExpected) {
    CAPTURE(expected.rho);
    FaceTable faces;
    BoxSurfaces surfaces = make_box_surfaces(make_surface(0, expected.rho));
    surfaces[kFloor].emission = Rgb(1);
    add_box_inward(faces, Vec3(0), Vec3(1), surfaces);
    fit_scene(faces);
    const SolverSettings settings;
    Solution run = solve_scene(faces, settings, 0);
    for (size_t k = 0; k < 3; ++k) {
      CAPTURE(kPasses[k]);
      advance_to(run, kPasses[k]);
      CHECK(std::abs(mean_radiosity(run, faces, kFloor) - expected.means[k][0]) <= kMeanError);
      CHECK(std::abs(mean_radiosity(run, faces, kCeiling) - expected.means[k][1]) <= kMeanError);
      for (const uint32_t wall : {kLeft, kRight, kFront, kBack})
        CHECK(std::abs(mean_radiosity(run, faces, wall) - expected.means[k][2]) <= kMeanError);
    }
  }
}

TEST_CASE("two open plates: means, and the power that leaves between them") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, make_surface(1, 0.5f));
  add_quad(faces, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, make_surface(0, 0.8f));
  fit_scene(faces);
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 1);
  constexpr double kFactor = 0.199824895698387;  // Howell C-11
  CHECK(std::abs(mean_radiosity(run, faces, 0) - 1) <= 1e-6);
  CHECK(std::abs(mean_radiosity(run, faces, 1) - 0.8 * kFactor) <= kMeanError);
  const PowerLedger ledger = find_power_ledger(run);
  // Each plate is half of the area 1. What the first plate sends past the second is gone at once.
  CHECK(ledger.emitted.g == doctest::Approx(0.5).epsilon(1e-6));
  // 65536 stratified rays: four standard errors of as many random ones are more.
  const double error = 4 * std::sqrt(kFactor * (1 - kFactor) / 65536);
  CHECK(std::abs(ledger.escaped.g / ledger.emitted.g - (1 - kFactor)) <= error);
  // The second plate keeps a fifth of what it gets and has not sent the rest.
  CHECK(std::abs(ledger.absorbed.g / ledger.emitted.g - 0.2 * kFactor) <= kMeanError);
  CHECK(std::abs(ledger.unshot.g / ledger.emitted.g - 0.8 * kFactor) <= kMeanError);
}

TEST_CASE("a spherical cap and its base disc exchange light by their areas alone") {
  // All that the flat disc sends reaches the cap, so by reciprocity the cap sends A_disc / A_cap back and the
  // rest to itself. On a sphere, every point of the cap sees equally much of it: both surfaces are uniform.
  constexpr float kRhoDisc = 0.6f, kRhoCap = 0.4f;
  double faceting_before = 1;
  for (const uint32_t stacks : {3u, 6u}) {
    CAPTURE(stacks);
    FaceTable faces;
    const double angle = std::numbers::pi / 3;  // height 0.5 of radius 1
    const uint32_t slices = 3 * stacks;
    const uint32_t cap = add_sphere(faces, Vec3(0), 1, stacks, slices, angle, true,
                                    [&](uint32_t) { return make_surface(1, kRhoCap); });
    // The rim is the cap's own, bit by bit.
    std::vector<Vec3> rim;
    for (uint32_t k = 0; k < slices; ++k) rim.push_back(faces.corners[(stacks - 1) * slices + k][1]);
    if (cross(rim[0] - Vec3(0, 0.5f, 0), rim[1] - Vec3(0, 0.5f, 0)).y < 0)
      std::reverse(rim.begin(), rim.end());
    const uint32_t disc = add_fan(faces, {0, 0.5f, 0}, rim, make_surface(0, kRhoDisc));
    fit_scene(faces);
    double cap_area = 0, disc_area = 0;
    for (uint32_t f = 0; f < faces.size(); ++f)
      (faces.polygon[f] < disc ? cap_area : disc_area) += face_area(faces, f);
    const double back = disc_area / cap_area;
    // Both areas shrink with the corners; their ratio is 0.75 for the sphere.
    const double faceting = std::abs(back - 0.75);
    // Second order: half the size, a quarter of the difference.
    if (stacks > 3) CHECK(faceting < 0.3 * faceting_before);
    faceting_before = faceting;
    const SolverSettings settings;
    Solution run = solve_scene(faces, settings, 0);
    double b_disc = 0, b_cap = 1, sent_disc = 0, sent_cap = 1;
    for (uint32_t pass = 1; pass <= 16; ++pass) {
      const double to_disc = sent_cap, to_cap = back * sent_disc + (1 - back) * sent_cap;
      sent_disc = kRhoDisc * to_disc, sent_cap = kRhoCap * to_cap;
      b_disc += sent_disc, b_cap += sent_cap;
      if (pass != 1 && pass != 2 && pass != 16) continue;
      CAPTURE(pass);
      advance_to(run, pass);
      // On facets the light is uniform but for terms of the faceting itself.
      const double error = kMeanError + 0.2 * faceting;
      CHECK(std::abs(mean_radiosity(run, faces, disc, disc + 1) - b_disc) <= error);
      CHECK(std::abs(mean_radiosity(run, faces, cap, disc) - b_cap) <= error);
    }
  }
}

TEST_CASE("integrating sphere: light from one cap is the same everywhere else after every pass") {
  // Sumpner: on a sphere every point sees every area alike, so each bounce adds rho times the mean of the one
  // before.
  constexpr float kRho = 0.8f;
  FaceTable faces;
  const uint32_t stacks = 16, slices = 24;
  add_sphere(faces, Vec3(0), 1, stacks, slices, std::numbers::pi, true,
             [&](uint32_t stack) { return make_surface(stack < 3 ? 1.0f : 0.0f, kRho); });
  fit_scene(faces);
  double lit = 0, all = 0;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    all += face_area(faces, f);
    if (faces.emission[f].g > 0) lit += face_area(faces, f);
  }
  // Facets lie nearer to the centre than the sphere by up to this share, and see each other as much unlike.
  const double faceting = 1 - std::cos(std::numbers::pi / slices) * std::cos(std::numbers::pi / (2 * stacks));
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 0);
  for (const uint32_t pass : {1u, 2u, 16u}) {
    CAPTURE(pass);
    advance_to(run, pass);
    const double added = lit / all * kRho * (1 - std::pow(kRho, pass)) / (1 - kRho);
    const double error = kMeanError + 3 * faceting * added;
    CHECK(std::abs(mean_radiosity(run, faces, 0, 3 * slices) - (1 + added)) <= error);
    CHECK(std::abs(mean_radiosity(run, faces, 3 * slices, stacks * slices) - added) <= error);
    // Flux through the whole is exact whatever the facets: sum over bounces of the lit share.
    CHECK(std::abs(mean_radiosity(run, faces, 0, stacks * slices) - (lit / all + added)) <= kMeanError);
  }
}

TEST_CASE("concentric spheres exchange light by their areas alone") {
  constexpr float kRhoInner = 0.5f, kRhoOuter = 0.7f;
  FaceTable faces;
  const uint32_t outer = add_sphere(faces, Vec3(0), 1, 12, 20, std::numbers::pi, true,
                                    [&](uint32_t) { return make_surface(0, kRhoOuter); });
  const uint32_t inner = add_sphere(faces, Vec3(0), 0.5f, 12, 20, std::numbers::pi, false,
                                    [&](uint32_t) { return make_surface(1, kRhoInner); });
  const uint32_t end = next_polygon(faces);
  fit_scene(faces);
  double inner_area = 0, outer_area = 0;
  for (uint32_t f = 0; f < faces.size(); ++f)
    (faces.polygon[f] < inner ? outer_area : inner_area) += face_area(faces, f);
  // The inner one is convex: all that it sends reaches the outer one.
  const double back = inner_area / outer_area;
  const SolverSettings settings;
  Solution run = solve_scene(faces, settings, 0);
  double b_inner = 1, b_outer = 0, sent_inner = 1, sent_outer = 0;
  for (uint32_t pass = 1; pass <= 16; ++pass) {
    const double to_inner = sent_outer, to_outer = back * sent_inner + (1 - back) * sent_outer;
    sent_inner = kRhoInner * to_inner, sent_outer = kRhoOuter * to_outer;
    b_inner += sent_inner, b_outer += sent_outer;
    if (pass != 1 && pass != 2 && pass != 16) continue;
    CAPTURE(pass);
    advance_to(run, pass);
    CHECK(std::abs(mean_radiosity(run, faces, inner, end) - b_inner) <= kMeanError);
    CHECK(std::abs(mean_radiosity(run, faces, outer, inner) - b_outer) <= kMeanError);
  }
}

TEST_CASE("a window lets in what a bright panel before it sends, however wide the panel") {
  for (const float side : {8.0f, 400.0f}) {
    CAPTURE(side);
    FaceTable faces;
    const Surface wall = make_surface(0, 0.5f);
    const auto x0 = [](float y, float z) { return Vec3(0, y, z); };
    // The wall at x = 0 around a window of 1 x 1, seen from inside.
    add_quad(faces, x0(0, 0), x0(1, 0), x0(1, 4), x0(0, 4), wall);
    add_quad(faces, x0(2, 0), x0(3, 0), x0(3, 4), x0(2, 4), wall);
    add_quad(faces, x0(1, 0), x0(2, 0), x0(2, 1.5f), x0(1, 1.5f), wall);
    add_quad(faces, x0(1, 2.5f), x0(2, 2.5f), x0(2, 4), x0(1, 4), wall);
    add_quad(faces, {0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}, wall);
    add_quad(faces, {0, 3, 0}, {4, 3, 0}, {4, 3, 4}, {0, 3, 4}, wall);
    add_quad(faces, {4, 0, 0}, {4, 0, 4}, {4, 3, 4}, {4, 3, 0}, wall);
    add_quad(faces, {0, 0, 4}, {0, 3, 4}, {4, 3, 4}, {4, 0, 4}, wall);
    add_quad(faces, {0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}, wall);
    const float h = side / 2;
    const std::array<Vec3, 4> panel = {Vec3(-2, 1.5f - h, 2 - h), Vec3(-2, 1.5f + h, 2 - h),
                                       Vec3(-2, 1.5f + h, 2 + h), Vec3(-2, 1.5f - h, 2 + h)};
    // What passes the window, by Lambert's formula at the middles of 16 x 16 parts: within 1e-4.
    double passed = 0;
    for (int j = 0; j < 16; ++j)
      for (int k = 0; k < 16; ++k)
        passed += find_point_form_factor(DVec3(0, 1 + (j + 0.5) / 16, 1.5 + (k + 0.5) / 16), DVec3(-1, 0, 0),
                                         panel) /
                  256;
    add_quad(faces, panel[0], panel[1], panel[2], panel[3], make_surface(1, 0));
    const Vec3 normal = faces.normal.back();
    REQUIRE(normal.x > 0.99f);
    // As the loader does it: of about the size 1, whatever shines on it.
    map_scene(faces, 0.1f, Vec3(0));
    const double window = 0.01;
    SolverSettings settings;
    settings.patch_count_max = 40000;
    settings.rays = 64;
    settings.threshold = 0.3f;
    const Solution s = solve_scene(faces, settings, 1);
    const double received = polygon_power(s, faces, 0, 9, element_irradiance(s)).g;
    // Rays find the window's edges: a hundredth.
    CHECK(received / window == doctest::Approx(passed).epsilon(0.012));
  }
}

TEST_CASE("a strong lamp in the next room takes nothing from a weak one in this room") {
  double received[2];
  for (int k = 0; k < 2; ++k) {
    FaceTable faces;
    const Surface wall = make_surface(0, 0.5f);
    const uint32_t room = add_box_inward(faces, {4, 0, 0}, {8, 3, 4}, make_box_surfaces(wall));
    add_box_inward(faces, {0, 0, 0}, {4, 3, 4}, make_box_surfaces(wall));
    // Under the ceilings, a table in between, so that rays are needed.
    add_quad(faces, {5.6f, 2.9f, 1.6f}, {6.4f, 2.9f, 1.6f}, {6.4f, 2.9f, 2.4f}, {5.6f, 2.9f, 2.4f},
             make_surface(1, 0));
    add_quad(faces, {1.6f, 2.9f, 1.6f}, {2.4f, 2.9f, 1.6f}, {2.4f, 2.9f, 2.4f}, {1.6f, 2.9f, 2.4f},
             make_surface(k == 0 ? 1.0f : 1000.0f, 0));
    add_box_outward(faces, {5, 0.5f, 1}, {7, 0.7f, 2}, wall);
    map_scene(faces, 0.1f, Vec3(0));
    const Solution s = solve_scene(faces, {}, 1);
    received[k] = polygon_power(s, faces, room, room + 6, element_irradiance(s)).g;
  }
  // The shadow's edge, by other samples.
  CHECK(received[1] == doctest::Approx(received[0]).epsilon(2e-3));
}

TEST_CASE("a small bright lamp is not lost among walls that all emit") {
  BoxSurfaces walls = make_box_surfaces(make_surface(1, 0));
  FaceTable faces;
  const uint32_t room = add_box_inward(faces, {0, 0, 0}, {1, 1, 1}, walls);
  uint32_t floor = room;  // the face that looks up
  while (faces.normal[floor].y < 0.5f) ++floor;
  faces.emission[floor] = Rgb(0), faces.reflectance[floor] = Rgb(0.5f);
  // A sun before its sky: about as much light as all of that.
  const uint32_t lamp = add_quad(faces, {0.49f, 0.9f, 0.49f}, {0.51f, 0.9f, 0.49f}, {0.51f, 0.9f, 0.51f},
                                 {0.49f, 0.9f, 0.51f}, make_surface(1e4f, 0));
  map_scene(faces, 0.4f, Vec3(0));
  const Solution s = solve_scene(faces, {}, 1);
  const FaceFrameTable& frames = s.surfaces->frames;
  const std::vector<Rgb> irradiance = element_irradiance(s);
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    if (s.mesh.elements.face[row] != floor) continue;
    const Vec3 centre = cell_centre(frames, floor, s.mesh.elements.cell[row], s.mesh.elements.level[row]);
    const double factor = find_point_form_factor(DVec3(centre), DVec3(0, 1, 0), faces.corners[lamp]);
    // What the lamp hides of the walls is a ten-thousandth; the light bends by less than this over an
    // element.
    CHECK(irradiance[row].g == doctest::Approx(1 + (1e4 - 1) * factor).epsilon(5e-3));
  }
}

TEST_CASE("a room on a ground a hundred times as wide: its patches are tiny, and all light is a number") {
  FaceTable faces;
  const Surface grey = make_surface(0, 0.5f);
  add_box_inward(faces, {0, 0, 0}, {4, 3, 4}, make_box_surfaces(grey));
  add_box_outward(faces, {1, 0, 1}, {2, 1, 2}, grey);
  add_quad(faces, {1.5f, 2.9f, 1.5f}, {2.5f, 2.9f, 1.5f}, {2.5f, 2.9f, 2.5f}, {1.5f, 2.9f, 2.5f},
           make_surface(50, 0));
  add_quad(faces, {-250, -0.01f, -250}, {-250, -0.01f, 250}, {250, -0.01f, 250}, {250, -0.01f, -250}, grey);
  fit_scene(faces);
  const Solution s = solve_scene(faces, {}, 6);
  for (const Rgb& radiosity : s.mesh.elements.radiosity) {
    REQUIRE(std::isfinite(radiosity.g));
    REQUIRE(radiosity.g >= 0);
  }
  CHECK(find_power_ledger(s).closure_error <= 3e-3);
}

TEST_CASE("no light goes through a small shade from its inside to its outside") {
  FaceTable faces;
  const Surface white = make_surface(0, 0.8f);
  add_box_inward(faces, {0, 0, 0}, {5, 3, 4}, make_box_surfaces(make_surface(0, 0)));
  add_box_outward(faces, {4.25f, 1.45f, 0.65f}, {4.35f, 1.55f, 0.75f}, make_surface(100, 0));
  const auto first = static_cast<uint32_t>(faces.size());
  const float low = 1.35f, high = 1.65f;
  const std::array<Vec2, 4> corner = {Vec2(4.1f, 0.5f), Vec2(4.5f, 0.5f), Vec2(4.5f, 0.9f), Vec2(4.1f, 0.9f)};
  for (size_t k = 0; k < 4; ++k) {
    const Vec2 a = corner[k], b = corner[(k + 1) % 4];
    add_two_sided(
        faces,
        std::array{Vec3(a.x, low, a.y), Vec3(b.x, low, b.y), Vec3(b.x, high, b.y), Vec3(a.x, high, a.y)},
        white, white);
  }
  map_scene(faces, 0.1f, Vec3(0));
  const Solution s = solve_scene(faces, {}, 8);
  double inside = 0;
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    const uint32_t face = s.mesh.elements.face[row];
    if (face < first) continue;
    const Vec3 outwards = faces.corners[face][0] + faces.corners[face][2] - 0.2f * Vec3(4.3f, 1.5f, 0.7f);
    if (dot(outwards, faces.normal[face]) > 0)
      CHECK(largest(s.mesh.elements.radiosity[row]) == 0);
    else
      inside = std::max(inside, double{largest(s.mesh.elements.radiosity[row])});
  }
  CHECK(inside > 1);
}
