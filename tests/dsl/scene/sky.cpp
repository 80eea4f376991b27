// The maps sky and sun: what they say in each direction.
#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

Sky read_sky(const std::string& lines) {
  const Loaded loaded = load(kBase + lines);
  REQUIRE(loaded.errors.empty());
  return loaded.scene.sky;
}

TEST_CASE("a scene has no sky unless it says so") {
  CHECK(read_sky("").is_dark());
  CHECK(read_sky("sky: {emission: 0}\n").is_dark());
}

TEST_CASE("a plain sky is even, or goes from the horizon to the zenith") {
  const Sky even = read_sky("sky: {emission: [1, 2, 3], ground: 0.5}\n");
  CHECK(find_sky_emission(even, {0, 1, 0}) == Rgb(1, 2, 3));
  CHECK(find_sky_emission(even, {0, 0, 1}) == Rgb(1, 2, 3));
  CHECK(find_sky_emission(even, {0, -1, 0}) == Rgb(0.5f));
  const Sky graded = read_sky("sky: {zenith: 40, horizon: [100, 90, 80]}\n");
  // Half way at 30 degrees: the sine is 0.5.
  CHECK(find_sky_emission(graded, {0, 0.5f, 0.8660254f}) == Rgb(70, 65, 60));
}

TEST_CASE("an overcast sky of 70 is 90 overhead and 30 at the horizon") {
  const Sky sky = read_sky("sky: {kind: overcast, emission: 70}\n");
  // Without a number it is a usual day's.
  CHECK(find_sky_emission(read_sky("sky: {kind: overcast}\n"), {0, 1, 0}).g ==
        doctest::Approx(100.0 * 90 / 70));
  CHECK(find_sky_emission(sky, {0, 1, 0}).g == doctest::Approx(90));
  CHECK(find_sky_emission(sky, {1, 0, 0}).g == doctest::Approx(30));
}

TEST_CASE("the sun stands where azimuth and elevation say: east is x, north is -z") {
  const auto find_direction = [](const std::string& keys) {
    return read_sky("sun: {irradiance: 1, " + keys + "}\n").sun_direction;
  };
  const auto is_near = [](Vec3 a, Vec3 b) { return length(a - b) < 1e-6f; };
  CHECK(is_near(find_direction("azimuth: 90, elevation: 0"), {1, 0, 0}));
  CHECK(is_near(find_direction("azimuth: 0, elevation: 0"), {0, 0, -1}));
  CHECK(is_near(find_direction("azimuth: 180, elevation: 30"), {0, 0.5f, 0.8660254f}));
  CHECK(is_near(find_direction("direction: [0, 3, 4]"), {0, 0.6f, 0.8f}));
  CHECK(is_near(find_direction("direction: {azimuth: 180, elevation: 30}"), {0, 0.5f, 0.8660254f}));
}

TEST_CASE("the sun's emission is its irradiance over the squared sine of half its angle") {
  const Sky sky = read_sky("sun: {direction: [0, 1, 0], irradiance: [300, 200, 100], angle: 60}\n");
  CHECK(sky.sun_radius == doctest::Approx(std::numbers::pi / 6));
  CHECK(sky.sun_emission.r == doctest::Approx(1200));
  CHECK(sky.sun_emission.b == doctest::Approx(400));
  const Sky disc = read_sky("sun: {direction: [0, 1, 0], emission: 5e6}\n");
  CHECK(disc.sun_emission.g == doctest::Approx(5e6));
  // 0.53 degrees.
  CHECK(disc.sun_radius == doctest::Approx(0.0046251).epsilon(1e-4));
}

TEST_CASE("a clear sky goes by its sun, which may be dark") {
  const Sky sky =
      read_sky("sky: {kind: clear, emission: 60}\nsun: {azimuth: 90, elevation: 20, irradiance: 0}\n");
  REQUIRE(sky.clear);
  CHECK_FALSE(sky.has_sun());
  CHECK(luminance(find_sky_emission(sky, {0.94f, 0.342f, 0})) >
        4 * luminance(find_sky_emission(sky, {-0.94f, 0.342f, 0})));
}

TEST_CASE("neither sky nor sun changes where the scene's faces are") {
  const Scene with = load(kBase + "sky: {emission: 60}\nsun: {direction: [1, 1, 1], irradiance: 5}\n").scene;
  const Scene without = load(kBase).scene;
  CHECK(with.origin == without.origin);
  CHECK(with.units_per_length == without.units_per_length);
  CHECK(with.faces.corners == without.faces.corners);
}

TEST_CASE("a scene that only the sky lights is not told as dark; a sun that shines from below is told") {
  const std::string dark = kHead + kFloor;
  CHECK(count_slug(load(dark).warnings, "no-emitter") == 1);
  CHECK(count_slug(load(dark + "sky: {emission: 60}\n").warnings, "no-emitter") == 0);
  CHECK(count_slug(load(dark + "sun: {direction: [0, 1, 0], irradiance: 9}\n").warnings, "no-emitter") == 0);
  CHECK(count_slug(load(dark + "sun: {direction: [0, -1, 0], irradiance: 9}\n").warnings,
                   "sun-below-horizon") == 1);
}

TEST_CASE("settings list the sky and the sun with their places") {
  const Scene scene =
      load(kBase + "sky: {emission: [1, 2, 3]}\nsun: {direction: [0, 1, 0], irradiance: 9}\n").scene;
  const auto value_of = [&](const std::string& path) {
    for (size_t k = 0; k < scene.settings.size(); ++k)
      if (scene.settings.path[k] == path) return scene.settings.value[k];
    return std::string();
  };
  CHECK(value_of("sky.emission") == "[1, 2, 3]");
  CHECK(value_of("sky.kind") == "plain");
  CHECK(value_of("sun.irradiance") == "9");
  CHECK(value_of("sun.angle") == "0.53");
  CHECK(value_of("sun.azimuth").empty());
}

}  // namespace
}  // namespace patchlight::test
