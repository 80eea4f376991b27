// The matrix between polygons: known factors, rooms, sums, and what does not change it.
#include "engine/factors/polygon_factors.h"

#include "engine/base/parallel.h"
#include "tests/form_factor_cases.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

FactorTable find_table(const FaceTable& faces, const FactorSettings& settings = {}) {
  const size_t n = next_polygon(faces);
  const Tracer tracer = make_tracer(faces);
  const FactorScene scene = make_factor_scene(faces, n);
  FactorTable table = make_factor_table(scene, n);
  while (extend_factors(table, scene, faces, tracer, settings)) {
  }
  return table;
}

// Polygons of any number of corners.
void add_corners(FaceTable& faces, const Corners& corners) {
  if (corners.size() <= 4) {
    add_polygon(faces, corners, {});
    return;
  }
  Vec3 centre(0);
  for (const Vec3& p : corners) centre += p / static_cast<float>(corners.size());
  add_fan(faces, centre, corners, {});
}

// Polygons 0 and 1 of a known pair; its blockers follow, two-sided.
FaceTable make_pair_scene(const KnownPair& pair) {
  FaceTable faces;
  add_corners(faces, pair.a);
  add_corners(faces, pair.b);
  for (const Corners& blocker : pair.blockers) add_two_sided(faces, blocker, {}, {});
  fit_scene(faces);
  return faces;
}

double find_row_sum(const FactorTable& table, uint32_t i) {
  double sum = 0;
  for (uint32_t j = 0; j < table.size(); ++j) sum += find_factor(table, i, j);
  return sum;
}

// The error of a sum of factors: those of its terms are independent.
double find_row_error(const FactorTable& table, uint32_t i) {
  double squares = 0;
  for (uint32_t j = 0; j < table.size(); ++j)
    squares += find_factor_error(table, i, j) * find_factor_error(table, i, j);
  return std::sqrt(squares);
}

// B after so many passes, one value a polygon.
std::vector<double> find_radiosity(const FactorTable& table, const std::vector<double>& emission,
                                   const std::vector<double>& reflectance, uint32_t passes) {
  std::vector<double> radiosity = emission;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    std::vector<double> next = emission;
    for (uint32_t i = 0; i < table.size(); ++i)
      for (uint32_t j = 0; j < table.size(); ++j)
        next[i] += reflectance[i] * find_factor(table, i, j) * radiosity[j];
    radiosity = next;
  }
  return radiosity;
}

const BoxSurfaces kBlack = make_box_surfaces({});
// Floats of corners in engine lengths, where areas are about 1: 1e-7 of a length, and factors change by a few
// of that.
constexpr double kExact = 1e-6;

}  // namespace

TEST_CASE("polygons with nothing between have their known form factors, both ways, without a ray") {
  for (const auto* pairs : {&kFreePairs, &kHardPairs})
    for (const KnownPair& pair : *pairs) {
      CAPTURE(pair.name);
      const FaceTable faces = make_pair_scene(pair);
      const FactorTable table = find_table(faces);
      CHECK(table.ray_count == 0);
      CHECK(std::abs(find_factor(table, 0, 1) - pair.factor_ab) <= kExact);
      const double factor_ba = pair.factor_ab * table.area[0] / table.area[1];
      CHECK(std::abs(find_factor(table, 1, 0) - factor_ba) <= kExact);
      CHECK(find_factor_error(table, 0, 1) == 0);
    }
}

TEST_CASE("polygons with blockers between are within 1e-3, and within their own estimate") {
  for (const uint64_t seed : {1, 2, 3})
    for (const KnownPair& pair : kBlockedPairs) {
      CAPTURE(pair.name);
      CAPTURE(seed);
      const FaceTable faces = make_pair_scene(pair);
      const FactorTable table = find_table(faces, {.seed = seed});
      const double ratio = table.area[0] / table.area[1];
      const double error_ab = std::abs(find_factor(table, 0, 1) - pair.factor_ab);
      const double error_ba = std::abs(find_factor(table, 1, 0) - pair.factor_ab * ratio);
      CHECK(error_ab <= 1e-3);
      CHECK(error_ba <= 1e-3);
      CHECK(find_factor_error(table, 0, 1) <= 1e-3);
      CHECK(find_factor_error(table, 1, 0) <= 1e-3);
      // Three standard errors: one time in 370 for each of the 14 x 3, if errors were normal, and estimates
      // are on the safe side.
      CHECK(error_ab <= find_factor_error(table, 0, 1) + kExact);
    }
}

TEST_CASE("a smaller error takes more rays and is reached") {
  const KnownPair& pair = kBlockedPairs[0];
  const FaceTable faces = make_pair_scene(pair);
  const FactorTable usual = find_table(faces), fine = find_table(faces, {.error = 1e-4});
  CHECK(fine.ray_count > 4 * usual.ray_count);
  CHECK(std::abs(find_factor(fine, 0, 1) - pair.factor_ab) <= 1e-4);
  CHECK(find_factor_error(fine, 0, 1) <= 1e-4);
  CHECK(fine.rough_count == 0);
}

TEST_CASE("a small polygon has the factor of the point that it stands for") {
  // From the middle of the unit square to the square above it (Howell B-3, four times), free and through a
  // screen; from the foot of a wall to it (B-4). A square of 2 h differs from its middle by about h * h.
  constexpr float kHalf = 1e-4f;
  const auto make_small = [](Vec3 p) {
    return Corners{p + Vec3(-kHalf, -kHalf, 0), p + Vec3(kHalf, -kHalf, 0), p + Vec3(kHalf, kHalf, 0),
                   p + Vec3(-kHalf, kHalf, 0)};
  };
  const Corners screen = {{0.4f, 0.4f, 0.5f}, {0.6f, 0.4f, 0.5f}, {0.6f, 0.6f, 0.5f}, {0.4f, 0.6f, 0.5f}};
  const KnownPair free{"", make_small({0.5f, 0.5f, 0}), kAbove, {}, 0.239456470460774};
  const KnownPair screened{"", make_small({0.5f, 0.5f, 0}), kAbove, {screen}, 0.191099446990945};
  const KnownPair foot{
      "", make_small({0, 0, 0}), {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}, {}, 0.055734197002554};
  CHECK(std::abs(find_factor(find_table(make_pair_scene(free)), 0, 1) - free.factor_ab) <= kExact);
  CHECK(std::abs(find_factor(find_table(make_pair_scene(foot)), 0, 1) - foot.factor_ab) <= kExact);
  CHECK(std::abs(find_factor(find_table(make_pair_scene(screened)), 0, 1) - screened.factor_ab) <= 1e-3);
}

TEST_CASE("in closed rooms rows sum to 1, and every pair of entries is one exchange") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(2, 1, 3), kBlack);
  fit_scene(faces);
  const FactorTable table = find_table(faces);
  for (uint32_t i = 0; i < 6; ++i) {
    CHECK(std::abs(find_row_sum(table, i) - 1) <= kExact);
    CHECK(find_factor(table, i, i) == 0);
    for (uint32_t j = 0; j < 6; ++j)
      CHECK(table.area[i] * find_factor(table, i, j) ==
            doctest::Approx(table.area[j] * find_factor(table, j, i)).epsilon(1e-15));
  }
}

TEST_CASE("in a room with a box in it rows sum to 1 within their errors, and all that emit 1 - rho show 1") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), kBlack);
  for (const Corners& side : kBox) add_polygon(faces, side, {});
  fit_scene(faces);
  const FactorTable table = find_table(faces);
  double error_max = 0;
  for (uint32_t i = 0; i < table.size(); ++i) {
    CHECK(std::abs(find_row_sum(table, i) - 1) <= find_row_error(table, i) + kExact);
    error_max = std::max(error_max, find_row_error(table, i));
  }
  const std::vector<double> reflectance = {0.1, 0.8, 0.3, 0.5, 0.7, 0.9, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6};
  std::vector<double> emission;
  for (const double rho : reflectance) emission.push_back(1 - rho);
  // An error of rows grows to rho / (1 - rho) of it.
  for (const double b : find_radiosity(table, emission, reflectance, 300))
    CHECK(std::abs(b - 1) <= error_max * 0.9 / 0.1);
}

TEST_CASE("one value a wall: a cube whose floor emits, and two plates, have their known solutions") {
  FaceTable cube;
  add_box_inward(cube, Vec3(0), Vec3(1), kBlack);
  fit_scene(cube);
  const FactorTable table = find_table(cube);
  const std::vector<double> emission = {1, 0, 0, 0, 0, 0};
  const auto check = [&](double rho, uint32_t passes, std::array<double, 3> expected) {
    const std::vector<double> b = find_radiosity(table, emission, std::vector<double>(6, rho), passes);
    CAPTURE(rho);
    CAPTURE(passes);
    CHECK(std::abs(b[kFloor] - expected[0]) <= 10 * kExact);
    CHECK(std::abs(b[kCeiling] - expected[1]) <= 10 * kExact);
    for (const uint32_t wall : {kLeft, kRight, kFront, kBack})
      CHECK(std::abs(b[wall] - expected[2]) <= 10 * kExact);
  };
  // The linear system of six unknowns with Howell's C-11 and C-14.
  check(0.5, 1, {1, 0.0999124478491935, 0.10002188803770162});
  check(0.5, 2, {1.050000009581724, 0.1399299601956996, 0.14001750755564413});
  check(0.5, 16, {1.090906554976185, 0.18174328297627793, 0.18183372581461862});
  check(0.8, 16, {1.532959155197559, 0.6707860722902566, 0.6709161954569807});
  for (const double rho : {0.5, 0.9, 0.99}) {
    CAPTURE(rho);
    for (const double b : find_radiosity(table, std::vector<double>(6, 1), std::vector<double>(6, rho), 16))
      CHECK(b == doctest::Approx((1 - std::pow(rho, 17)) / (1 - rho)).epsilon(1e-5));
  }
  const FactorTable plates = find_table(make_pair_scene({"", kSquare, kAbove, {}, 0}));
  const std::vector<double> b = find_radiosity(plates, {1, 0}, {0.5, 0.8}, 60);
  CHECK(std::abs(b[0] - 1.0162312408839456) <= kExact);
  CHECK(std::abs(b[1] - 0.16245464137206145) <= kExact);
}

TEST_CASE("a spherical cap sees itself as its share of the sphere, and its base with all of it") {
  // The cap down to polar angle 2 pi / 3 of the unit sphere, seen from inside, and the disc that closes it:
  // areas 2 pi (1 + 1 / 2) and 3 / 4 pi. F_cap,cap = area / (4 pi) = 3 / 4. Facets lose area: h * h.
  constexpr double kAngle = 2 * std::numbers::pi / 3;
  FaceTable faces;
  add_sphere(faces, Vec3(0), 1, 10, 20, kAngle, true, [](uint32_t) { return Surface{}; });
  const auto height = static_cast<float>(std::cos(kAngle)), radius = static_cast<float>(std::sin(kAngle));
  const uint32_t disc = add_fan(faces, Vec3(0, height, 0), make_ring(Vec3(0, height, 0), radius, 20, 1), {});
  fit_scene(faces);
  const FactorTable table = find_table(faces);
  CHECK(std::abs(find_row_sum(table, disc) - 1) <= 1e-5);
  double area = 0, within = 0, to_disc = 0;
  for (uint32_t i = 0; i < disc; ++i) {
    CHECK(std::abs(find_row_sum(table, i) - 1) <= 1e-5);
    area += table.area[i];
    to_disc += table.area[i] * find_factor(table, i, disc);
    for (uint32_t j = 0; j < disc; ++j) within += table.area[i] * find_factor(table, i, j);
  }
  CHECK(to_disc == doctest::Approx(table.area[disc]).epsilon(1e-5));
  CHECK(std::abs(within / area - 0.75) <= 0.01);
}

TEST_CASE("the factor to a polygon is the sum of those to its parts") {
  FaceTable whole, parts;
  const Corners wide = {{0, 2, 1}, {3, 2, 1}, {3, 0, 1}, {0, 0, 1}};
  add_polygon(whole, kSquare, {});
  add_polygon(whole, wide, {});
  add_polygon(parts, kSquare, {});
  add_quad(parts, {0, 2, 1}, {1.2f, 2, 1}, {0.4f, 0, 1}, {0, 0, 1}, {});
  add_triangle(parts, {1.2f, 2, 1}, {3, 2, 1}, {0.4f, 0, 1}, {});
  add_triangle(parts, {3, 2, 1}, {3, 0, 1}, {0.4f, 0, 1}, {});
  const FactorTable one = find_table(whole), three = find_table(parts);
  CHECK(std::abs(find_factor(one, 0, 1) - find_row_sum(three, 0)) <= kExact);
}

TEST_CASE("one polygon of many faces is one polygon") {
  // The square above as sixteen faces; a plate whose middle is missing, as the eight that surround it.
  FaceTable cells, plate;
  add_polygon(cells, kSquare, {});
  add_polygon(plate, kSquare, {});
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const float x = 0.25f * static_cast<float>(i), y = 0.25f * static_cast<float>(j), s = 0.25f;
      add_face(cells, std::array{Vec3(x, y + s, 1), Vec3(x + s, y + s, 1), Vec3(x + s, y, 1), Vec3(x, y, 1)},
               1, {});
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != 1 || j != 1) {
        const auto x = static_cast<float>(i), y = static_cast<float>(j);
        add_face(plate,
                 std::array{Vec3(x, y + 1, 1), Vec3(x + 1, y + 1, 1), Vec3(x + 1, y, 1), Vec3(x, y, 1)}, 1,
                 {});
      }
  CHECK(std::abs(find_factor(find_table(cells), 0, 1) - kFreePairs[0].factor_ab) <= kExact);
  FaceTable full, middle;
  add_polygon(full, kSquare, {}), add_polygon(middle, kSquare, {});
  add_quad(full, {0, 3, 1}, {3, 3, 1}, {3, 0, 1}, {0, 0, 1}, {});
  add_quad(middle, {1, 2, 1}, {2, 2, 1}, {2, 1, 1}, {1, 1, 1}, {});
  const double expected = find_factor(find_table(full), 0, 1) - find_factor(find_table(middle), 0, 1);
  CHECK(std::abs(find_factor(find_table(plate), 0, 1) - expected) <= kExact);
}

TEST_CASE("light passes a hole and not what would fill it: both together are all of it") {
  const auto find_with = [](bool frame, bool plug) {
    FaceTable faces;
    add_polygon(faces, kSquare, {});
    add_polygon(faces, kAbove, {});
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if ((i == 1 && j == 1) ? plug : frame) {
          const float x = 0.5f * static_cast<float>(i) - 0.25f, y = 0.5f * static_cast<float>(j) - 0.25f;
          add_face(faces,
                   std::array{Vec3(x, y, 0.5f), Vec3(x + 0.5f, y, 0.5f), Vec3(x + 0.5f, y + 0.5f, 0.5f),
                              Vec3(x, y + 0.5f, 0.5f)},
                   2, {});
        }
    fit_scene(faces);
    return find_table(faces);
  };
  const FactorTable framed = find_with(true, false), plugged = find_with(false, true);
  const double error = find_factor_error(framed, 0, 1) + find_factor_error(plugged, 0, 1);
  CHECK(std::abs(find_factor(framed, 0, 1) + find_factor(plugged, 0, 1) - kFreePairs[0].factor_ab) <= error);
  CHECK(find_factor(framed, 0, 1) > 0.01);
  CHECK(find_factor(find_with(true, true), 0, 1) <= 1e-3);
}

TEST_CASE("a two-sided polygon has a row for each side, and back sides only absorb") {
  FaceTable faces;
  add_polygon(faces, kSquare, {});
  add_polygon(faces, kAbove, {});
  const Corners middle = {{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}};
  const uint32_t up = add_two_sided(faces, middle, {}, {});
  fit_scene(faces);
  const FactorTable table = find_table(faces);
  const double near = find_factor(table, 0, up + 1);
  CHECK(near > 0.3);
  CHECK(std::abs(find_factor(table, up, 1) - near) <= kExact);
  CHECK(find_factor(table, 0, up) == 0);
  CHECK(find_factor(table, up, up + 1) == 0);
  // The middle hides all of one from all of the other, which is certain: all lines cross it.
  CHECK(find_factor(table, 0, 1) == 0);
  CHECK(find_factor_error(table, 0, 1) == 0);
  CHECK(table.hidden_count == 1);
  CHECK(table.ray_count == 0);
}

TEST_CASE("a polygon that is not flat sees itself") {
  // Two right triangles that share an edge at a right angle: F = (3 - sqrt 3) / 6 from one to the other.
  FaceTable faces;
  add_face(faces, std::array{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, 0, {});
  add_face(faces, std::array{Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)}, 0, {});
  const FactorTable table = find_table(faces);
  CHECK(std::abs(find_factor(table, 0, 0) - (3 - std::sqrt(3.0)) / 6) <= kExact);
}

TEST_CASE("parts of a bent polygon have the error of one entry between them") {
  // Bent in the middle, with a screen over it.
  FaceTable faces;
  add_face(faces, std::array{Vec3(0, 0, 0), Vec3(0.5f, 0, 0.1f), Vec3(0.5f, 1, 0.1f), Vec3(0, 1, 0)}, 0, {});
  add_face(faces, std::array{Vec3(0.5f, 0, 0.1f), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0.5f, 1, 0.1f)}, 0, {});
  add_polygon(faces, kAbove, {});
  add_two_sided(
      faces, Corners{{0.3f, 0.3f, 0.5f}, {0.7f, 0.3f, 0.5f}, {0.7f, 0.7f, 0.5f}, {0.3f, 0.7f, 0.5f}}, {}, {});
  fit_scene(faces);
  const FactorTable table = find_table(faces);
  CHECK(table.sampled_count >= 2);
  CHECK(find_factor_error(table, 0, 1) <= 1e-3);
  CHECK(find_factor_error(table, 1, 0) <= 1e-3);
}

TEST_CASE("surfaces that touch exchange nothing") {
  // A box on a floor: its bottom lies in the floor, and the floor under it sees back sides.
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), kBlack);
  const uint32_t box = add_box_outward(faces, Vec3(0.25f, 0, 0.25f), Vec3(0.75f, 0.5f, 0.75f), {});
  fit_scene(faces);
  const FactorTable table = find_table(faces);
  CHECK(find_factor(table, kFloor, box + kFloor) == 0);
  CHECK(find_row_sum(table, box + kFloor) == 0);
  CHECK(std::abs(find_row_sum(table, kFloor) - 0.75) <= find_row_error(table, kFloor) + kExact);
  for (const uint32_t i : {uint32_t{kCeiling}, uint32_t{kLeft}, box + kCeiling, box + kLeft})
    CHECK(std::abs(find_row_sum(table, i) - 1) <= find_row_error(table, i) + kExact);
}

TEST_CASE("the bits do not depend on threads, and samples depend on the seed") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), kBlack);
  for (const Corners& side : kBox) add_polygon(faces, side, {});
  fit_scene(faces);
  const auto find_with = [&](size_t threads) {
    const WorkersScope scope(std::make_shared<Workers>(threads));
    return find_table(faces);
  };
  const FactorTable one = find_with(1);
  for (const size_t count : {2, 3, 8}) {
    const FactorTable many = find_with(count);
    CHECK((many.exchange == one.exchange));
    CHECK((many.exchange_error == one.exchange_error));
    CHECK(many.ray_count == one.ray_count);
  }
  const FactorTable other = find_table(faces, {.seed = 2});
  CHECK((other.exchange != one.exchange));
}

TEST_CASE("scenes of one polygon, of none, and polygons without faces") {
  CHECK(find_table(FaceTable{}).size() == 0);
  FaceTable one;
  add_polygon(one, kSquare, {});
  CHECK(find_factor(find_table(one), 0, 0) == 0);
  // Polygon 1 of three has no face.
  FaceTable gap;
  add_face(gap, kSquare, 0, {});
  add_face(gap, kAbove, 2, {});
  const FactorTable table = find_table(gap);
  CHECK(table.area[1] == 0);
  CHECK(find_row_sum(table, 1) == 0);
  CHECK(std::abs(find_factor(table, 0, 2) - kFreePairs[0].factor_ab) <= kExact);
}

TEST_CASE("the forecast of bytes grows with the square of the polygons") {
  CHECK(forecast_factor_bytes(1000, 1000) < 20'000'000);
  CHECK(forecast_factor_bytes(1'000'000, 1'000'000) > 5'000'000'000'000);
}

TEST_CASE("a cancelled run throws") {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), kBlack);
  const auto workers = std::make_shared<Workers>(2);
  const WorkersScope scope(workers);
  workers->request_cancel();
  CHECK_THROWS_AS(find_table(faces), Cancelled);
}
