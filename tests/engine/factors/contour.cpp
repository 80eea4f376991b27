// The contour integral: closed forms, limits, and Lambert's formula as the other method.
#include "engine/factors/contour.h"

#include "engine/base/sobol.h"
#include "engine/light/lambert.h"

#include <doctest/doctest.h>

#include <array>

using namespace patchlight;

namespace {

using Polygon = std::vector<DVec3>;

std::vector<Segment> make_outline(const Polygon& corners) {
  std::vector<Segment> outline;
  for (size_t k = 0; k < corners.size(); ++k)
    outline.push_back({corners[k], corners[(k + 1) % corners.size()]});
  return outline;
}

double find_exchange(const Polygon& a, const Polygon& b, double tolerance = 1e-9) {
  ContourScratch scratch;
  return find_exchange_area(make_outline(a), make_outline(b), tolerance, scratch);
}

Polygon make_square(double size, double height, bool up) {
  if (up) return {{0, 0, height}, {size, 0, height}, {size, size, height}, {0, size, height}};
  return {{0, size, height}, {size, size, height}, {size, 0, height}, {0, 0, height}};
}

// Howell C-11 for squares of 1 at a distance.
double opposite_squares(double distance) {
  const double x = 1 / distance, y = std::sqrt(1 + x * x);
  return 2 / (std::numbers::pi * x * x) *
         (std::log(y * y / std::sqrt(1 + 2 * x * x)) + 2 * x * y * std::atan(x / y) - 2 * x * std::atan(x));
}

}  // namespace

TEST_CASE("opposite squares: the closed form, from a gap of 1e-4 to one of 100") {
  for (const double gap : {1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0}) {
    CAPTURE(gap);
    const double factor = find_exchange(make_square(1, 0, true), make_square(1, gap, false));
    CHECK(std::abs(factor - opposite_squares(gap)) <= 2e-9);
  }
}

TEST_CASE("far squares: the factor of points, relative") {
  // (size / distance)^2 / pi, less 2 / 3 (size / distance)^2 of it.
  for (const double distance : {1e3, 1e4}) {
    CAPTURE(distance);
    const double expected = 1 / (std::numbers::pi * distance * distance);
    const double factor =
        find_exchange(make_square(1, 0, true), make_square(1, distance, false), 1e-6 * expected);
    // Rounding: 1e-15 of the outlines' lengths, 16, beside 1 / distance^2.
    CHECK(std::abs(factor / expected - 1) <= 1 / (distance * distance) + 1e-14 * distance * distance);
  }
}

TEST_CASE("squares that share an edge: the closed form at a right angle, and all of the sky at none") {
  const Polygon floor = make_square(1, 0, true);
  const auto wall = [](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return Polygon{{0, 0, 0}, {0, 1, 0}, {c, 1, s}, {c, 0, s}};
  };
  CHECK(std::abs(find_exchange(floor, wall(std::numbers::pi / 2)) - 0.200043776075403) <= 2e-9);
  // Long plates that enclose a small angle lose 1 - F = sin(angle / 2) at the open side; squares lose more.
  CHECK(find_exchange(floor, wall(0.01)) > 0.98);
  CHECK(find_exchange(floor, wall(3.1)) < 1e-3);
}

TEST_CASE("any two polygons before each other's planes agree with Lambert's formula averaged over the one") {
  uint32_t compared = 0;
  for (uint32_t trial = 0; trial < 40; ++trial) {
    const auto point = [&](uint32_t k) {
      const Vec2 a = make_jitter(trial, 2 * k), b = make_jitter(trial, 2 * k + 1);
      return DVec3(a.x, a.y, b.x);
    };
    // A triangle in z = 0, and one above it whose plane has the first one in front.
    const Polygon a = {point(0) * DVec3(1, 1, 0), point(1) * DVec3(1, 1, 0), point(2) * DVec3(1, 1, 0)};
    Polygon b = {point(3) + DVec3(0, 0, 0.1), point(4) + DVec3(0, 0, 0.1), point(5) + DVec3(0, 0, 0.1)};
    const DVec3 across_a = cross(a[1] - a[0], a[2] - a[0]);
    const DVec3 across_b = cross(b[1] - b[0], b[2] - b[0]);
    double low = 1, high = -1;
    for (const DVec3& p : a)
      low = std::min(low, dot(p - b[0], across_b)), high = std::max(high, dot(p - b[0], across_b));
    if (low < 0 && high > 0) continue;
    Polygon up = a;
    if (across_a.z < 0) std::swap(up[1], up[2]);
    if (high <= 0) std::swap(b[1], b[2]);
    const std::array<Vec3, 3> target = {Vec3(b[0]), Vec3(b[1]), Vec3(b[2])};
    const Sobol sobol = make_sobol(trial);
    double sum = 0;
    constexpr uint32_t kPoints = 4096;
    for (uint32_t k = 0; k < kPoints; ++k) {
      const auto [u, v, unused, unused_too] = make_point(sobol, find_sobol_bits(k));
      const double s = std::sqrt(u);
      sum += find_point_form_factor(up[0] + s * (1 - v) * (up[1] - up[0]) + s * v * (up[2] - up[0]),
                                    {0, 0, 1}, target);
    }
    const double area = 0.5 * std::abs(across_a.z);
    CAPTURE(trial);
    ++compared;
    // Scrambled points of a smooth function: 4096^-1.5 = 4e-6 of it or less; the target's corners are floats.
    CHECK(std::abs(find_exchange(up, b) / area - sum / kPoints) <= 1e-5);
  }
  CHECK(compared >= 10);
}

TEST_CASE("edges of length nothing, and nothing at all, change nothing") {
  const Polygon a = make_square(1, 0, true), b = make_square(1, 1, false);
  Polygon doubled = b;
  doubled.insert(doubled.begin() + 1, doubled[1]);
  CHECK(find_exchange(a, doubled) == doctest::Approx(find_exchange(a, b)).epsilon(1e-9));
  CHECK(find_exchange(a, {}) == 0);
  CHECK(find_exchange({}, b) == 0);
}

TEST_CASE("very far squares: the factor of points, to many digits") {
  for (const double distance : {1e5, 1e7, 1e9, 1e12}) {
    CAPTURE(distance);
    const double expected = 1 / (std::numbers::pi * distance * distance);
    const double factor =
        find_exchange(make_square(1, 0, true), make_square(1, distance, false), 1e-6 * expected);
    CHECK(std::abs(factor / expected - 1) <= 1e-9);
  }
}

TEST_CASE("a small square over a very large one, near and far, and in its corner") {
  for (const double size : {1e-5, 1e-7, 1e-9})
    for (const double height : {0.3, 30.0, 3000.0}) {  // of the small one's size
      CAPTURE(size);
      CAPTURE(height);
      // Over the middle: all of the sky but what lies beyond the border, some (height / half)^2.
      const double middle = 0.5 - size / 2;
      const Polygon above = {{middle, middle, size * height},
                             {middle, middle + size, size * height},
                             {middle + size, middle + size, size * height},
                             {middle + size, middle, size * height}};
      const double all = find_exchange(above, make_square(1, 0, true), 1e-12 * size * size);
      // Places near 0.5 are doubles, too.
      const double far = 4 * size * height * size * height + 0x1p-52 / size;
      CHECK(std::abs(all / (size * size) - 1) <= far + 1e-8);
      // Over the corner, at a height of many of its sizes, a quarter of it.
      const Polygon corner = {{0, 0, size * height},
                              {0, size, size * height},
                              {size, size, size * height},
                              {size, 0, size * height}};
      const double quarter = find_exchange(corner, make_square(1, 0, true), 1e-12 * size * size);
      if (height > 1000) CHECK(std::abs(quarter / (size * size) - 0.25) <= 1 / height + far);
      // The same by the double integral alone, of squares less unlike.
      if (height < 1000) {
        const double near = find_exchange({{0, 0, height}, {0, 1, height}, {1, 1, height}, {1, 0, height}},
                                          make_square(9000, 0, true), 1e-12);
        CHECK(std::abs(quarter / (size * size) - near) <= 2 * height * height / 9000.0 / 9000.0 + 1e-8);
      }
    }
}
