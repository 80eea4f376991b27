// Form factors of scenes as users write them: closed forms, closed rooms, and brute force, one kind of
// geometry after the other. Figures are Howell's (A Catalog of Radiation Heat Transfer Configuration
// Factors), unless another source is named.
#include "dsl/scene/load.h"
#include "engine/base/sobol.h"
#include "engine/factors/polygon_factors.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

using namespace patchlight;

namespace {

using Ring = std::vector<DVec3>;

struct Found {
  std::map<std::string, uint32_t> index;
  FactorTable table;
  double units_per_length = 1;
  double factor(const std::string& from, const std::string& to) const {
    return find_factor(table, index.at(from), index.at(to));
  }
  double error(const std::string& from, const std::string& to) const {
    return find_factor_error(table, index.at(from), index.at(to));
  }
};

Found find_factors(const std::string& objects, double error = 1e-3) {
  std::vector<Diagnostic> warnings;
  LoadOptions options;
  options.fine_corners = true;
  const Scene scene =
      load_scene_text("patchlight: 1\nmaterials: {m: {reflectance: 0.5}}\nobjects:\n" + objects, "test.yaml",
                      warnings, options);
  Found found;
  for (uint32_t p = 0; p < scene.polygons.size(); ++p) found.index[scene.polygons.id[p]] = p;
  found.units_per_length = scene.units_per_length;
  const Tracer tracer = make_tracer(scene.faces);
  const FactorScene factors = make_factor_scene(scene.faces, scene.polygons.size(),
                                                {scene.fine_corners, scene.origin / scene.units_per_length});
  found.table = make_factor_table(factors, scene.polygons.size());
  while (extend_factors(found.table, factors, scene.faces, tracer, {.error = error})) {
  }
  return found;
}

std::string write_polygon(const std::string& id, const Ring& ring, int decimals = 17,
                          bool two_sided = false) {
  std::string text = fmt::format("  - {{id: {}, material: m, two_sided: {}, polygon: [", id, two_sided);
  for (const DVec3& p : ring)
    text += decimals < 17
                ? fmt::format("[{:.{}f}, {:.{}f}, {:.{}f}], ", p.x, decimals, p.y, decimals, p.z, decimals)
                : fmt::format("[{:.17g}, {:.17g}, {:.17g}], ", p.x, p.y, p.z);
  return text.substr(0, text.size() - 2) + "]}\n";
}

struct Sums {
  double sum = 0, error = 0;  // of independent errors
};
Sums sum_row(const FactorTable& table, uint32_t i) {
  Sums sums;
  for (uint32_t j = 0; j < table.size(); ++j) {
    sums.sum += find_factor(table, i, j);
    sums.error = std::hypot(sums.error, find_factor_error(table, i, j));
  }
  return sums;
}

// Numbers that differ from call to call and not from run to run.
struct Dice {
  uint64_t count = 0, key = 1;
  double draw(double low, double high) {
    const double u = static_cast<double>(mix_bits(key * 0x9e3779b97f4a7c15ull + ++count) >> 11) * 0x1p-53;
    return low + u * (high - low);
  }
};

// A turn by a random unit quaternion.
std::array<DVec3, 3> make_turn(Dice& dice) {
  double w = 0, x = 0, y = 0, z = 0, squares = 0;
  do {
    w = dice.draw(-1, 1), x = dice.draw(-1, 1), y = dice.draw(-1, 1), z = dice.draw(-1, 1);
    squares = w * w + x * x + y * y + z * z;
  } while (squares > 1 || squares < 0.01);
  const double n = 1 / std::sqrt(squares);
  w *= n, x *= n, y *= n, z *= n;
  return {DVec3(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)),
          DVec3(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)),
          DVec3(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y))};
}
Ring turn_ring(const std::array<DVec3, 3>& turn, const Ring& ring, DVec3 move = DVec3(0)) {
  Ring turned;
  for (const DVec3& p : ring) turned.push_back(move + p.x * turn[0] + p.y * turn[1] + p.z * turn[2]);
  return turned;
}

// Counter-clockwise seen from above (up), or from below.
Ring make_level(double x0, double x1, double y0, double y1, double z, bool up) {
  if (up) return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

// A sum over the corners of two rectangles, with their signs.
template <class Term>
double sum_corners(std::array<double, 2> x, std::array<double, 2> y, std::array<double, 2> u,
                   std::array<double, 2> v, const Term& term) {
  double sum = 0;
  for (const int k : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}) {
    const int a = k & 1, b = k >> 1 & 1, c = k >> 2 & 1, d = k >> 3;
    sum += ((a + b + c + d) % 2 == 0 ? 1 : -1) * term(x[a], y[b], u[c], v[d]);
  }
  return sum / (2 * std::numbers::pi * (x[1] - x[0]) * (y[1] - y[0]));
}

// C-13: from x by y to u by v, parallel, at a distance.
double find_parallel(std::array<double, 2> x, std::array<double, 2> y, std::array<double, 2> u,
                     std::array<double, 2> v, double distance) {
  return sum_corners(x, y, u, v, [&](double a, double b, double c, double d) {
    const double p = a - c, q = b - d, z = distance;
    const double across_p = std::hypot(p, z), across_q = std::hypot(q, z);
    return q * across_p * std::atan(q / across_p) + p * across_q * std::atan(p / across_q) -
           z * z / 2 * std::log(p * p + q * q + z * z);
  });
}

// C-15: from x by y, in a plane, to heights v by y' (u) in the plane x = 0 that stands on it.
double find_perpendicular(std::array<double, 2> x, std::array<double, 2> y, std::array<double, 2> u,
                          std::array<double, 2> v) {
  return sum_corners(x, y, u, v, [&](double a, double b, double c, double d) {
    const double k = a * a + d * d, q = b - c, root = std::sqrt(k);
    return (root > 0 ? q * root * std::atan(q / root) : 0) - 0.25 * (k - q * q) * std::log(k + q * q);
  });
}

}  // namespace

TEST_CASE("parallel rectangles that are offset, of all proportions, have Howell's C-13") {
  Dice dice;
  for (int k = 0; k < 40; ++k) {
    const std::array<double, 2> x = {0, dice.draw(0.1, 3)}, y = {0, dice.draw(0.1, 3)};
    const double u0 = dice.draw(-3, 3), v0 = dice.draw(-3, 3);
    const std::array<double, 2> u = {u0, u0 + dice.draw(0.1, 3)}, v = {v0, v0 + dice.draw(0.1, 3)};
    const double distance = dice.draw(0.05, 5);
    CAPTURE(k);
    const auto turn = make_turn(dice);
    const Found found = find_factors(
        write_polygon("a", turn_ring(turn, make_level(x[0], x[1], y[0], y[1], 0, true))) +
        write_polygon("b", turn_ring(turn, make_level(u[0], u[1], v[0], v[1], distance, false))));
    CHECK(std::abs(found.factor("a", "b") - find_parallel(x, y, u, v, distance)) <= 1e-6);
    CHECK(found.error("a", "b") == 0);
  }
}

TEST_CASE("perpendicular rectangles, touching or apart, have Howell's C-15") {
  Dice dice;
  for (int k = 0; k < 40; ++k) {
    const double x0 = k % 3 == 0 ? 0 : dice.draw(0, 2), z0 = k % 2 == 0 ? 0 : dice.draw(0, 2),
                 u0 = dice.draw(-3, 3);
    const std::array<double, 2> x = {x0, x0 + dice.draw(0.1, 3)}, y = {0, dice.draw(0.1, 3)};
    const std::array<double, 2> u = {u0, u0 + dice.draw(0.1, 3)}, z = {z0, z0 + dice.draw(0.1, 3)};
    CAPTURE(k);
    const auto turn = make_turn(dice);
    const Ring wall = {{0, u[0], z[0]}, {0, u[1], z[0]}, {0, u[1], z[1]}, {0, u[0], z[1]}};
    const Found found =
        find_factors(write_polygon("a", turn_ring(turn, make_level(x[0], x[1], y[0], y[1], 0, true))) +
                     write_polygon("b", turn_ring(turn, wall)));
    CHECK(std::abs(found.factor("a", "b") - find_perpendicular(x, y, u, z)) <= 1e-6);
  }
}

TEST_CASE("plates that touch nearly, beside a far ground, in sizes from 1e-6 to 1e6") {
  Dice dice;
  for (int k = 0; k < 60; ++k) {
    const double size = std::pow(10, dice.draw(-6, 0)), gap = size * std::pow(10, dice.draw(-4, 0.5));
    const double reach = std::pow(10, dice.draw(1, 6)), depth = std::pow(10, dice.draw(-1, 5));
    const double low = 0.37;
    CAPTURE(size);
    CAPTURE(gap);
    CAPTURE(reach);
    CAPTURE(depth);
    // `high` looks down at `low`, `back` away from both, at the ground.
    const Found found =
        find_factors(write_polygon("low", make_level(0, size, 0, size, low, true)) +
                     write_polygon("high", make_level(0, size, 0, size, low + gap, false)) +
                     write_polygon("back", make_level(-size, 0, 0, size, low, false)) +
                     write_polygon("ground", make_level(-reach, reach, -reach, reach, -depth, true)));
    // The gap as the file's doubles have it.
    const double there = (low + gap) - low;
    const double expected = find_parallel({0, 1}, {0, 1}, {0, 1}, {0, 1}, there / size);
    CHECK(std::abs(found.factor("low", "high") - expected) <= found.error("low", "high") + 1e-6);
    // A point above the middle of a square, four times B-3.
    const double b = reach / (depth + low), root = std::sqrt(1 + b * b);
    const double sky = 4 / std::numbers::pi * b / root * std::atan(b / root);
    CHECK(std::abs(found.factor("back", "ground") - sky) <=
          found.error("back", "ground") + 1e-6 + 2 * size / (depth + low) * size / (depth + low));
    for (const char* to : {"low", "high"})
      CHECK((found.factor("ground", to) > 0 || found.error("ground", to) > 0 || std::string(to) == "high" ||
             found.factor("low", "ground") == 0));
  }
}

TEST_CASE("a quarter of the way hidden, in sizes from 1e-6 to 1, turned, beside far grounds of up to 1e6") {
  // View3D's example of a quarter (Walton: Calculation of Obstructed View Factors by Adaptive Integration).
  constexpr double kExpected = 0.149868671774;
  Dice dice;
  for (const double size : {1e-6, 1e-4, 1e-2, 1.0})
    for (const double reach : {10.0, 1e3, 1e6}) {
      CAPTURE(size);
      CAPTURE(reach);
      const auto turn = make_turn(dice);
      // Single precision has no corners for the smallest of them, so far from the scene's middle.
      const Found found = find_factors(
          write_polygon("low", turn_ring(turn, make_level(0, size, 0, size, 0, true))) +
          write_polygon("high", turn_ring(turn, make_level(0, size, 0, size, size, false))) +
          write_polygon("plate", turn_ring(turn, make_level(0, size / 2, 0, size / 2, size / 2, true))) +
          write_polygon("ground", make_level(-reach, reach, -reach, reach, -2 - reach / 10, true)));
      CHECK(std::abs(found.factor("low", "high") - kExpected) <= found.error("low", "high") + 1e-6);
      CHECK(found.error("low", "high") <= 1e-3);
    }
}

TEST_CASE("a plate between two: a corner off the plane changes the factor by its own size, not more") {
  // Unit squares three apart, a tenth of a square half way between. Its shadow integral: by points of `a` the
  // factor to `b` less that to what the plate hides of it, midpoint rule of 400 x 400.
  constexpr double kExpected = 0.0318464;
  Dice dice;
  for (int k = 0; k < 8; ++k) {
    const auto turn = make_turn(dice);
    for (const double off : {-1e-3, -1e-4, -1e-5, -1e-6, 0.0, 1e-6, 1e-5, 1e-4, 1e-3})
      for (const bool of_a : {false, true}) {
        CAPTURE(k);
        CAPTURE(off);
        CAPTURE(of_a);
        Ring a = make_level(0, 1, 0, 1, 0, true), b = make_level(0, 1, 0, 1, 3, false);
        (of_a ? a : b)[static_cast<size_t>(k % 4)].z += off;
        const Found found =
            find_factors(write_polygon("a", turn_ring(turn, a)) + write_polygon("b", turn_ring(turn, b)) +
                         write_polygon("p", turn_ring(turn, make_level(0.45, 0.55, 0.45, 0.55, 1.5, true))));
        // The error told, and the corner: a factor changes by less than its share of the distance.
        CHECK(std::abs(found.factor("a", "b") - kExpected) <=
              found.error("a", "b") + std::abs(off) * 0.1 + 1e-6);
        CHECK(found.error("a", "b") <= 1e-3);
      }
  }
}

TEST_CASE("the two sides of one sheet see nothing of each other, however its corners are rounded") {
  Dice dice;
  int count = 0;
  for (int k = 0; k < 300; ++k) {
    const auto corners = static_cast<size_t>(3 + k % 8);
    const bool is_round = k % 2 == 0;  // else its outline may have corners that turn inwards
    Ring ring;
    for (size_t c = 0; c < corners; ++c) {
      const double angle =
          2 * std::numbers::pi * (static_cast<double>(c) + dice.draw(0, 0.8)) / static_cast<double>(corners);
      const double radius = is_round ? 1 : dice.draw(0.4, 1);
      ring.push_back(
          {radius * std::cos(angle), radius * std::sin(angle),
           dice.draw(-1, 1) * std::array{0.0, 1e-6, 1e-5, 1e-4, 1e-3}[static_cast<size_t>(k % 5)]});
    }
    const int decimals = 3 + k % 4;
    const Ring turned =
        turn_ring(make_turn(dice), ring, {dice.draw(-2, 2), dice.draw(-2, 2), dice.draw(-2, 2)});
    CAPTURE(k);
    const Found found = find_factors(write_polygon("p", turned, decimals, true));
    // Corners up to 1e-3 off the plane, and what rounding adds, over faces that are a tenth as high: two
    // planes at that angle see its square over 4 of each other, and around corners that turn inwards the one
    // side sees as little of the other.
    const double bend = 10 * (2e-3 + std::pow(10, -decimals));
    for (uint32_t i = 0; i < 2; ++i)
      for (uint32_t j = 0; j < 2; ++j) {
        CHECK(find_factor(found.table, i, j) <= bend * bend / 4);
        CHECK(find_factor_error(found.table, i, j) <= bend * bend / 4);
      }
    ++count;
  }
  CHECK(count == 300);
}

TEST_CASE("closed rooms of rounded corners: rows sum to 1 within their errors") {
  Dice dice;
  for (int k = 0; k < 24; ++k) {
    const auto sides = static_cast<size_t>(3 + k % 6);
    const int decimals = 3 + k / 6;
    const auto turn = make_turn(dice);
    const DVec3 move(dice.draw(-2, 2), dice.draw(-2, 2), dice.draw(-2, 2));
    const double height = dice.draw(0.3, 2);
    Ring floor, ceiling;
    for (size_t c = 0; c < sides; ++c) {
      const double angle =
          2 * std::numbers::pi * (static_cast<double>(c) + dice.draw(0, 0.5)) / static_cast<double>(sides);
      floor.emplace_back(std::cos(angle), std::sin(angle), 0);
      ceiling.emplace_back(std::cos(angle), std::sin(angle), height);
    }
    std::string objects;
    for (size_t c = 0; c < sides; ++c) {
      const size_t next = (c + 1) % sides;
      objects +=
          write_polygon(fmt::format("wall{}", c),
                        turn_ring(turn, {floor[next], floor[c], ceiling[c], ceiling[next]}, move), decimals);
    }
    objects += write_polygon("floor", turn_ring(turn, floor, move), decimals);
    objects += write_polygon("ceiling", turn_ring(turn, {ceiling.rbegin(), ceiling.rend()}, move), decimals);
    CAPTURE(sides);
    CAPTURE(decimals);
    const Found found = find_factors(objects);
    for (uint32_t i = 0; i < found.table.size(); ++i) {
      const Sums sums = sum_row(found.table, i);
      // Three standard errors of each; four in a row's sum, of some hundred rows.
      CHECK(std::abs(sums.sum - 1) <= 4.0 / 3 * sums.error + 1e-5);
    }
  }
}

TEST_CASE("a closed cylinder: ends, wall and wall to itself come to C-41's as its sides become many") {
  for (const double height : {0.5, 2.0}) {
    // Facets of n sides are off by 1 / n^2: Richardson's extrapolation takes that off.
    const auto find_ends = [&](size_t sides) {
      Ring floor, ceiling;
      for (size_t c = 0; c < sides; ++c) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(c) / static_cast<double>(sides);
        floor.emplace_back(std::cos(angle), std::sin(angle), 0);
        ceiling.emplace_back(std::cos(angle), std::sin(angle), height);
      }
      std::string objects =
          write_polygon("floor", floor) + write_polygon("ceiling", {ceiling.rbegin(), ceiling.rend()});
      for (size_t c = 0; c < sides; ++c) {
        const size_t next = (c + 1) % sides;
        objects +=
            write_polygon(fmt::format("wall{}", c), {floor[next], floor[c], ceiling[c], ceiling[next]});
      }
      const Found found = find_factors(objects);
      for (uint32_t i = 0; i < found.table.size(); ++i)
        CHECK(std::abs(sum_row(found.table, i).sum - 1) <= 1e-5);
      return found.factor("floor", "ceiling");
    };
    const double found = (4 * find_ends(48) - find_ends(24)) / 3;
    const double r = 1 / height, x = 2 + 1 / (r * r);
    CHECK(std::abs(found - (x - std::sqrt(x * x - 4)) / 2) <= 1e-4);
  }
}

TEST_CASE(
    "a ball in a ball: all that leaves the inner one arrives, and the outer one sees 1 - A1 / A2 of itself") {
  const Found found = find_factors(
      "  - {id: inner, sphere: {radius: 1, sides: 12}, material: m}\n"
      "  - {id: outer, sphere: {radius: 2, sides: 12, inward: true}, material: m}\n");
  double inner = 0, outer = 0, across = 0, within = 0;
  for (const auto& [id, i] : found.index) {
    const bool is_inner = id.starts_with("inner");
    (is_inner ? inner : outer) += found.table.area[i];
    CHECK(std::abs(sum_row(found.table, i).sum - 1) <= 4.0 / 3 * sum_row(found.table, i).error + 1e-5);
    for (const auto& [other, j] : found.index) {
      if (is_inner && other.starts_with("inner")) CHECK(find_exchange(found.table, i, j) == 0);
      if (is_inner && other.starts_with("outer")) across += find_exchange(found.table, i, j);
      if (!is_inner && other.starts_with("outer")) within += find_exchange(found.table, i, j);
    }
  }
  // Errors of thousands of pairs, at random.
  CHECK(across / inner == doctest::Approx(1).epsilon(1e-3));
  CHECK(within / outer == doctest::Approx(1 - inner / outer).epsilon(1e-3));
}

TEST_CASE("a plate in a cube has the obstructed factor of NISTIR 6925 (Walton, 2002), table 1") {
  std::string objects = write_polygon("floor", make_level(0, 1, 0, 1, 0, true));
  objects += write_polygon("side", {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  objects += write_polygon("far", {{1, 1, 0}, {1, 1, 1}, {0, 1, 1}, {0, 1, 0}});
  objects += write_polygon(
      "plate", {{0.25, 0.75, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.75, 0.75}, {0.25, 0.75, 0.75}}, 17, true);
  const Found found = find_factors(objects);
  CHECK(std::abs(found.factor("side", "far") - 0.11562061) <= found.error("side", "far") + 1e-6);
  CHECK(found.error("side", "far") <= 1e-3);
}

TEST_CASE("random oblique polygons with random plates between them: pairs of points by brute force") {
  Dice dice;
  const Sobol sobol = make_sobol(7);
  for (int k = 0; k < 12; ++k) {
    const Ring a =
        turn_ring(make_turn(dice), make_level(0, dice.draw(0.5, 1.5), 0, dice.draw(0.5, 1.5), 0, true));
    const Ring b =
        turn_ring(make_turn(dice), make_level(0, dice.draw(0.5, 1.5), 0, dice.draw(0.5, 1.5), 0, true),
                  {dice.draw(-1, 1), dice.draw(-1, 1), dice.draw(2, 3)});
    std::vector<Ring> plates;
    std::string objects = write_polygon("a", a, 17, true) + write_polygon("b", b, 17, true);
    for (int p = 0; p < 3; ++p) {
      plates.push_back(turn_ring(make_turn(dice), make_level(0, 0.5, 0, 0.5, 0, true),
                                 {dice.draw(-0.5, 0.5), dice.draw(-0.5, 0.5), dice.draw(0.8, 1.6)}));
      objects += write_polygon(fmt::format("p{}", p), plates.back());
    }
    const Found found = find_factors(objects);
    // Factors from either side of a to either side of b, all at once.
    std::array<double, 4> sums{};
    const DVec3 ua = a[1] - a[0], va = a[3] - a[0], ub = b[1] - b[0], vb = b[3] - b[0];
    const DVec3 na = normalize(cross(ua, va)), nb = normalize(cross(ub, vb));
    const double area_b = length(cross(ub, vb));
    constexpr uint32_t kPairs = 1u << 16;
    for (uint32_t n = 0; n < kPairs; ++n) {
      const auto point = make_point(sobol, find_sobol_bits(n));
      const DVec3 from = a[0] + point[0] * ua + point[1] * va, to = b[0] + point[2] * ub + point[3] * vb;
      bool blocked = false;
      for (const Ring& plate : plates) {
        const DVec3 u = plate[1] - plate[0], v = plate[3] - plate[0], normal = cross(u, v);
        const double t = dot(plate[0] - from, normal) / dot(to - from, normal);
        const DVec3 at = from + t * (to - from) - plate[0];
        const double p = dot(at, u) / dot(u, u), q = dot(at, v) / dot(v, v);
        blocked = blocked || (t > 0 && t < 1 && p > 0 && p < 1 && q > 0 && q < 1);
      }
      // The two themselves may stand in each other's way where their planes cross: they do not here, for
      // light that leaves one side stays on it.
      if (blocked) continue;
      const DVec3 way = to - from;
      const double squared = dot(way, way);
      const double cosine_a = dot(way, na), cosine_b = -dot(way, nb);
      sums[(cosine_a > 0 ? 0 : 2) + (cosine_b > 0 ? 0 : 1)] +=
          std::abs(cosine_a * cosine_b) / (std::numbers::pi * squared * squared) * area_b / kPairs;
    }
    CAPTURE(k);
    const std::array<std::array<const char*, 2>, 4> names = {
        {{"a", "b"}, {"a", "b.back"}, {"a.back", "b"}, {"a.back", "b.back"}}};
    for (size_t n = 0; n < 4; ++n) {
      CAPTURE(n);
      // 65,536 pairs at random: a share of F of kernels about as large as their mean, three standard errors.
      const double expected = sums[n], noise = 3 * std::sqrt(expected / kPairs);
      const double factor = found.factor(names[n][0], names[n][1]),
                   error = found.error(names[n][0], names[n][1]);
      CHECK(std::abs(factor - expected) <= error + noise);
    }
  }
}
