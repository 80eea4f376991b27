#include "engine/light/lambert.h"

#include "engine/base/sampling.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

using namespace patchlight;

namespace {

const DVec3 kUp(0, 0, 1);
const std::vector<Vec3> kSquareAbove = {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}};

}  // namespace

TEST_CASE("point form factors have their closed forms") {
  // Lambert's sum in double: rounding alone.
  constexpr double kError = 1e-12;
  // Howell B-3, four times: 4 / (pi sqrt 5) atan(1 / sqrt 5).
  const double centre = 4 / (std::numbers::pi * std::sqrt(5)) * std::atan(1 / std::sqrt(5));
  CHECK(std::abs(find_point_form_factor({0.5, 0.5, 0}, kUp, kSquareAbove) - centre) <= kError);
  CHECK(std::abs(centre - 0.239456470460774) <= kError);
  // Howell B-4.
  const std::vector<Vec3> wall = {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};
  CHECK(std::abs(find_point_form_factor({0, 0, 0}, kUp, wall) - 0.055734197002554) <= kError);
  // A screen of a fifth of the square half way up hides what it covers itself; its corners are floats.
  const std::vector<Vec3> screen = {
      {0.4f, 0.6f, 0.5f}, {0.6f, 0.6f, 0.5f}, {0.6f, 0.4f, 0.5f}, {0.4f, 0.4f, 0.5f}};
  const double open = find_point_form_factor({0.5, 0.5, 0}, kUp, kSquareAbove) -
                      find_point_form_factor({0.5, 0.5, 0}, kUp, screen);
  CHECK(std::abs(open - 0.191099446990945) <= 1e-7);
}

TEST_CASE("point form factor: a polygon cut in two gives the sum of its parts") {
  for (uint32_t trial = 0; trial < 200; ++trial) {
    const auto pick = [&](uint32_t k) {
      const Vec2 a = make_jitter(trial, 2 * k), b = make_jitter(trial, 2 * k + 1);
      return DVec3(2 * a.x - 1, 2 * a.y - 1, b.x);
    };
    // Corners of a triangle on a coarse grid, so that the cut's ends are floats, too.
    const auto corner = [&](uint32_t k) {
      const DVec3 p = pick(k);
      return Vec3(std::round(p.x * 64) / 32, std::round(p.y * 64) / 32, std::round(p.z * 64) / 32);
    };
    const Vec3 a = corner(0), b = corner(1), c = corner(2), m = 0.5f * (b + c);
    const DVec3 point = pick(3) - DVec3(0, 0, 0.5), normal = normalize(pick(4) + DVec3(0, 0, 0.2));
    const double whole = find_point_form_factor(point, normal, std::array{a, b, c});
    const double parts = find_point_form_factor(point, normal, std::array{a, b, m}) +
                         find_point_form_factor(point, normal, std::array{a, m, c});
    REQUIRE(std::abs(whole - parts) <= 1e-12);
    // One side sees it or the other, and nobody sees more than all.
    const double other = find_point_form_factor(point, normal, std::array{a, c, b});
    REQUIRE(std::min(whole, other) <= 1e-12);
    REQUIRE(whole <= 1);
  }
}

TEST_CASE("point form factor: back sides and what lies below the horizon give nothing") {
  const std::vector<Vec3> turned(kSquareAbove.rbegin(), kSquareAbove.rend());
  CHECK(find_point_form_factor({0.5, 0.5, 0}, kUp, turned) == 0);
  CHECK(find_point_form_factor({0.5, 0.5, 2}, kUp, kSquareAbove) == 0);
  CHECK(find_point_form_factor({0.5, 0.5, 0}, -kUp, kSquareAbove) == 0);
}

TEST_CASE("point form factor: the horizon cuts a polygon off exactly") {
  // A wall through the horizon counts as its upper part does.
  const std::vector<Vec3> through = {{1, 0, -1}, {1, 0, 1}, {1, 1, 1}, {1, 1, -1}};
  const std::vector<Vec3> above = {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};
  CHECK(std::abs(find_point_form_factor({0, 0.2, 0}, kUp, through) -
                 find_point_form_factor({0, 0.2, 0}, kUp, above)) <= 1e-14);
  // One corner above it.
  const std::vector<Vec3> tip = {{1, -1, -1}, {1, 0, 1}, {1, 1, -1}};
  const std::vector<Vec3> tip_above = {{1, -0.5f, 0}, {1, 0, 1}, {1, 0.5f, 0}};
  const double a = find_point_form_factor({0, 0, 0}, kUp, tip),
               b = find_point_form_factor({0, 0, 0}, kUp, tip_above);
  CHECK(std::abs(a - b) <= 1e-14);
}

TEST_CASE("point form factor: a polygon that fills the sky gives 1, one seen edge-on gives 0") {
  const std::vector<Vec3> sky = {{-1e6f, 1e6f, 1}, {1e6f, 1e6f, 1}, {1e6f, -1e6f, 1}, {-1e6f, -1e6f, 1}};
  // What remains below the rim: about 1e-12.
  CHECK(std::abs(find_point_form_factor({0, 0, 0}, kUp, sky) - 1) <= 1e-11);
  const std::vector<Vec3> in_plane = {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  CHECK(find_point_form_factor({0, 0, 0}, kUp, in_plane) == 0);
  // The point on a corner or on an edge: no division by nothing.
  for (const DVec3& point : {DVec3(0, 0, 1), DVec3(0.5, 0, 1), DVec3(0.5, 0.5, 1)}) {
    const double factor = find_point_form_factor(point, kUp, kSquareAbove);
    CHECK(factor >= 0);
    CHECK(factor <= 1);
  }
}

TEST_CASE("point form factor does not depend on the size of the scene") {
  for (const float scale : {0x1p-20f, 0x1p20f}) {
    std::vector<Vec3> scaled;
    for (const Vec3& p : kSquareAbove) scaled.push_back(scale * p);
    CHECK(std::abs(find_point_form_factor(DVec3(0.3, 0.4, 0) * double{scale}, kUp, scaled) -
                   find_point_form_factor({0.3, 0.4, 0}, kUp, kSquareAbove)) <= 1e-14);
  }
}
