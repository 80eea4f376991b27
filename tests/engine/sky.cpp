// Skies by direction, against what their standards and papers say.
#include "engine/sky.h"

#include <doctest/doctest.h>

#include <functional>
#include <stdexcept>

using namespace patchlight;

namespace {

Vec3 look(double elevation, double azimuth) {
  return Vec3(DVec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                    -std::cos(elevation) * std::cos(azimuth)));
}

// What a horizontal plane receives of a sky: sine squared and azimuth are even on it.
DRgb find_horizontal(const Sky& sky) {
  constexpr int kRings = 200, kParts = 200;
  DRgb sum(0);
  for (int ring = 0; ring < kRings; ++ring)
    for (int part = 0; part < kParts; ++part)
      sum += DRgb(find_sky_emission(sky, look(std::acos(std::sqrt((ring + 0.5) / kRings)),
                                              2 * std::numbers::pi * (part + 0.5) / kParts)));
  return sum / double(kRings * kParts);
}

}  // namespace

TEST_CASE("sky: overcast is three times as bright overhead as at the horizon, in between by the sine") {
  const Sky sky = make_overcast_sky(Rgb(70));
  for (const double elevation : {0.0, 0.3, 0.7, 1.2, std::numbers::pi / 2})
    // CIE: L / Lz = (1 + 2 sin e) / 3.
    CHECK(find_sky_emission(sky, look(elevation, 1)).g ==
          doctest::Approx(90 * (1 + 2 * std::sin(elevation)) / 3).epsilon(1e-5));
  // 7/9 of the zenith's emission; the sum's error is of the second order in 1/200.
  CHECK(find_horizontal(sky).g == doctest::Approx(70).epsilon(1e-4));
  CHECK(find_sky_emission(sky, {0.6f, -0.8f, 0}) == Rgb(0));
}

TEST_CASE("sky: a uniform sky brings a horizontal plane its emission; the ground is what lies below") {
  Sky sky = make_uniform_sky(Rgb(1, 2, 3));
  sky.ground = Rgb(0.5f);
  CHECK(find_sky_emission(sky, {0, 1, 0}) == Rgb(1, 2, 3));
  CHECK(find_sky_emission(sky, {1, 0, 0}) == Rgb(1, 2, 3));
  CHECK(find_sky_emission(sky, {0.8f, -0.6f, 0}) == Rgb(0.5f));
}

TEST_CASE("sky: a clear sky has the coefficients and the zenith of Preetham, Shirley and Smits") {
  const ClearSky clear = find_clear_sky(2, {0, 1, 0});
  constexpr double kLuminance[5] = {-1.1056, -0.2833, 5.2797, -2.3359, 0.2363};
  for (size_t k = 0; k < 5; ++k) CHECK(clear.perez[0][k] == doctest::Approx(kLuminance[k]).epsilon(1e-9));
  // chi = (4/9 - 2/120) pi; (4.0453 2 - 4.9710) tan chi - 0.2155 2 + 2.4192.
  CHECK(clear.zenith.x == doctest::Approx(3.1196 * std::tan(77 * std::numbers::pi / 180) + 1.9882));
  // With the sun overhead only the last column counts.
  CHECK(clear.zenith.y == doctest::Approx(0.00394 * 2 + 0.25886));
  CHECK(clear.zenith.z == doctest::Approx(0.00516 * 2 + 0.26688));
  // Near sunset it is yellow there no longer: x = 0.2... and falls with the sun.
  const ClearSky evening = find_clear_sky(3, {1, 0, 0});
  CHECK(evening.zenith.x == doctest::Approx(2.4192 - 0.2155 * 3));
}

TEST_CASE(
    "sky: a clear sky brings a horizontal plane what is asked for, blue overhead and white at the sun") {
  const DVec3 sun = normalize(DVec3(0.6, 0.5, -0.3));
  const Sky sky = make_clear_sky(3, sun, Rgb(80));
  CHECK(luminance(Rgb(find_horizontal(sky))) == doctest::Approx(80).epsilon(2e-3));
  const Rgb away = find_sky_emission(sky, normalize(Vec3(-0.6f, 0.9f, 0.3f)));
  CHECK(away.b > 1.3f * away.r);
  const Rgb near = find_sky_emission(sky, Vec3(sun));
  CHECK(luminance(near) > 5 * luminance(away));
  CHECK(near.b / near.r < away.b / away.r);
  // Twice the light, the same colours.
  const Rgb twice = find_sky_emission(make_clear_sky(3, sun, Rgb(160)), normalize(Vec3(-0.6f, 0.9f, 0.3f)));
  CHECK(twice.r == doctest::Approx(2 * away.r).epsilon(1e-6));
}

TEST_CASE("sky: the sun is a disc of its radius") {
  Sky sky;
  sky.sun_direction = Vec3(0, 1, 0), sky.sun_radius = 0.0046f, sky.sun_emission = Rgb(1);
  CHECK(is_in_sun(sky, look(std::numbers::pi / 2 - 0.00459, 2)));
  CHECK_FALSE(is_in_sun(sky, look(std::numbers::pi / 2 - 0.00461, 2)));
}

TEST_CASE("sky: what is no sky is refused") {
  const auto refuses = [](const std::function<void(Sky&)>& spoil) {
    Sky sky = make_uniform_sky(Rgb(1));
    check_sky(sky);
    spoil(sky);
    CHECK_THROWS_AS(check_sky(sky), std::invalid_argument);
  };
  refuses([](Sky& sky) { sky.zenith.g = -1; });
  refuses([](Sky& sky) { sky.ground.b = std::nanf(""); });
  refuses([](Sky& sky) { sky.sun_direction = Vec3(1, 1, 0); });
  refuses([](Sky& sky) { sky.sun_radius = 2; });
  refuses([](Sky& sky) { sky.sun_emission = Rgb(1); });
}
