// Cells of the sky: what they bring to planes, and directions to them.
#include "engine/light/sky_pieces.h"

#include "engine/base/sampling.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace patchlight;

namespace {

// What a plane receives of all cells.
Rgb find_all(const Sky& sky, Vec3 normal, SkyDetail detail = SkyDetail::kCoarse) {
  const SkyPieces pieces = make_sky_pieces(sky, detail);
  SkyIrradiance out;
  for (uint32_t first = 0; first < pieces.size(); first += 64)
    find_sky_irradiance(out, pieces, sky, normal, first,
                        std::min(first + 64, static_cast<uint32_t>(pieces.size())));
  return std::accumulate(out.irradiance.begin(), out.irradiance.end(), Rgb(0));
}

Vec3 tilt(double angle, double azimuth) {
  return Vec3(
      DVec3(std::sin(angle) * std::cos(azimuth), std::cos(angle), std::sin(angle) * std::sin(azimuth)));
}

}  // namespace

TEST_CASE("sky pieces: a plane tilted by t receives (1 + cos t) / 2 of a uniform sky") {
  const Sky sky = make_uniform_sky(Rgb(1, 2, 4));
  for (const double angle : {0.0, 0.3, 1.0, std::numbers::pi / 2, 2.5, std::numbers::pi})
    for (const double azimuth : {0.0, 0.7, 4.0}) {
      CAPTURE(angle);
      const Rgb all = find_all(sky, tilt(angle, azimuth));
      // Sums of 1024 floats.
      CHECK(std::abs(double{all.r} - (1 + std::cos(angle)) / 2) <= 2e-6);
      CHECK(all.b == doctest::Approx(4 * all.r).epsilon(1e-5));
      CHECK(std::abs(find_all(sky, tilt(angle, azimuth), SkyDetail::kFine).r - all.r) <= 4e-6f);
    }
}

TEST_CASE("sky pieces: with an equal ground every plane receives the emission") {
  Sky sky = make_uniform_sky(Rgb(3));
  sky.ground = Rgb(3);
  CHECK(make_sky_pieces(sky).size() == 2048);
  for (const double angle : {0.0, 0.9, 2.0, 3.0})
    CHECK(find_all(sky, tilt(angle, 1.1)).g == doctest::Approx(3).epsilon(2e-6));
}

TEST_CASE("sky pieces: an overcast sky gives a wall 3/14 + 4/(7 pi) of what the ground receives") {
  const Sky sky = make_overcast_sky(Rgb(60));
  // Cells are summed up from parts of about a degree: an error of the square of that, 3e-5 of the difference.
  CHECK(find_all(sky, {0, 1, 0}).g == doctest::Approx(60).epsilon(5e-5));
  for (const double azimuth : {0.0, 0.4, 2.0})
    CHECK(find_all(sky, tilt(std::numbers::pi / 2, azimuth)).g ==
          doctest::Approx(60 * (3 / 14.0 + 4 / (7 * std::numbers::pi))).epsilon(3e-4));
}

TEST_CASE("sky pieces: a disc over a plane fills what a sum over its directions says") {
  for (const double radius : {0.0046, 0.1, 0.7})
    for (const double share : {-1.1, -0.9, -0.4, 0.0, 0.3, 0.8, 1.0, 1.5}) {
      const double elevation = share * radius;
      CAPTURE(radius);
      CAPTURE(share);
      const DVec3 middle(0, std::sin(elevation), std::cos(elevation)), side(1, 0, 0);
      const DVec3 up = cross(middle, side);
      double sum = 0;
      constexpr int kRings = 400, kParts = 400;
      for (int ring = 0; ring < kRings; ++ring)
        for (int part = 0; part < kParts; ++part) {
          // Even on the disc's projection; over the cosine to its middle it is a solid angle.
          const double sine = std::sqrt((ring + 0.5) / kRings) * std::sin(radius);
          const double turn = 2 * std::numbers::pi * (part + 0.5) / kParts;
          const double along = std::sqrt(1 - sine * sine);
          const DVec3 way = along * middle + sine * (std::cos(turn) * side + std::sin(turn) * up);
          sum += std::max(way.y, 0.0) / along;
        }
      const double squared = std::sin(radius) * std::sin(radius);
      // The rule's error, as a share of the largest value that the disc may have.
      CHECK(std::abs(find_disc_factor(std::sin(elevation), radius) - sum / (kRings * kParts) * squared) <=
            2e-4 * squared * std::sin(radius));
    }
}

TEST_CASE("sky pieces: weights of directions to the cells sum to the solid angle of the sky") {
  const Sky sky = make_uniform_sky(Rgb(1));
  const SkyPieces pieces = make_sky_pieces(sky);
  double sum = 0, largest_cell = 0, smallest_cell = 1;
  for (uint32_t row = 0; row < pieces.size(); ++row) {
    constexpr uint32_t kSide = 8;
    double cell = 0;
    for (uint32_t k = 0; k < kSide * kSide; ++k) {
      const Vec2 at(float(k % kSide) + 0.5f, float(k / kSide) + 0.5f);
      const SkySample sample = sample_sky(pieces, sky, row, at / float{kSide});
      CHECK(sample.direction.y >= 0);
      // Half of the weight is the share of the triangle: the weight holds twice its area.
      cell += double{sample.weight} / 2 / (kSide * kSide);
    }
    sum += cell;
    largest_cell = std::max(largest_cell, cell), smallest_cell = std::min(smallest_cell, cell);
  }
  CHECK(sum == doctest::Approx(2 * std::numbers::pi).epsilon(1e-3));
  CHECK(largest_cell < 2.5 * smallest_cell);
}

TEST_CASE("sky pieces: directions to the sun fill its disc evenly") {
  Sky sky;
  sky.sun_direction = normalize(Vec3(0.3f, 0.8f, -0.2f)), sky.sun_radius = 0.01f, sky.sun_emission = Rgb(1);
  const SkyPieces pieces = make_sky_pieces(sky);
  REQUIRE(pieces.size() == 1);
  uint32_t inner = 0;
  constexpr uint32_t kSide = 32;
  for (uint32_t k = 0; k < kSide * kSide; ++k) {
    const Vec2 at(float(k % kSide) + 0.5f, float(k / kSide) + 0.5f);
    const Vec3 way = sample_sky(pieces, sky, 0, at / float{kSide}).direction;
    CHECK(is_in_sun(sky, way));
    inner += length(way - sky.sun_direction) < 0.0075f;
  }
  // The map takes 24 of 32 rows and columns about the middle to three quarters of the radius.
  CHECK(inner == 24 * 24);
}
