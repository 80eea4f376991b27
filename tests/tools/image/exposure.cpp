// How bright a picture is, and what of it a display shows.
#include "tools/image/exposure.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace patchlight;

TEST_CASE("nine tenths of a picture stay below display-linear 0.7") {
  // 1..100: the 90th percentile is 91, so EV is log2(0.7 / 91) = -7.02.
  std::vector<float> brightness;
  for (int k = 100; k >= 1; --k) brightness.push_back(static_cast<float>(k));
  CHECK(pick_exposure_ev(brightness) == doctest::Approx(-7.02).epsilon(1e-12));
}

TEST_CASE("a few bright spots do not darken the room") {
  std::vector<float> brightness(1000, 1.0f);
  for (size_t k = 0; k < 50; ++k) brightness[k] = 1e6f;
  CHECK(pick_exposure_ev(brightness) == doctest::Approx(std::round(std::log2(0.7) * 100) / 100));
}

TEST_CASE("black pixels do not brighten the rest, and a black picture has EV 0") {
  std::vector<float> brightness(1000, 0.0f);
  CHECK(pick_exposure_ev(brightness) == 0);
  CHECK(pick_exposure_ev({}) == 0);
  brightness[3] = 0.7f;
  CHECK(pick_exposure_ev(brightness) == 0);
}

TEST_CASE("shown values are B times 2^EV, clipped to 0..1") {
  const std::vector<Rgb> values = {Rgb(0.25f, 1, 100), Rgb(0)};
  const std::vector<Rgb> shown = expose_values(values, -1);
  CHECK(shown[0].r == 0.125f);
  CHECK(shown[0].g == 0.5f);
  CHECK(shown[0].b == 1);
  CHECK(shown[1].r == 0);
}

TEST_CASE("pixels that show a lamp or nothing do not count for the exposure") {
  // Two faces of one element each, the second a lamp; four pixels: wall, lamp, half and half, nothing.
  FaceTable faces;
  faces.emission = {Rgb(0), Rgb(10)};
  Solution solution;
  solution.mesh.elements.face = {0, 1};
  FilmTable film;
  film.width = 4;
  film.height = 1;
  film.pixel_first = {0, 1, 2, 4, 4};
  film.value = {0, 1, 0, 1};
  film.weight = {1, 1, 0.5f, 0.5f};
  const std::vector<Rgb> values = {Rgb(3, 2, 1), Rgb(10)};
  std::vector<float> brightness;
  collect_brightness(brightness, film, values, solution, faces, false);
  REQUIRE(brightness.size() == 1);
  CHECK(brightness[0] == doctest::Approx(3));
}

TEST_CASE("lines of the mesh darken light ground and stay visible on black") {
  std::vector<Rgb> pixels = {Rgb(1), Rgb(0), Rgb(0.5f)};
  const std::vector<float> cover = {1, 1, 0};
  draw_mesh_lines(pixels, cover);
  CHECK(luminance(pixels[0]) < 0.6f);
  CHECK(luminance(pixels[1]) > 0.01f);
  CHECK(pixels[2].r == 0.5f);
}

TEST_CASE("the filmic curve goes through its published points, and never falls") {
  const auto show = [](float value) {
    return expose_values(std::vector<Rgb>{Rgb(value)}, 0, find_tone("filmic"))[0].g;
  };
  // x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)
  CHECK(show(0) == 0);
  CHECK(show(1) == doctest::Approx(2.54 / 3.16).epsilon(1e-6));
  CHECK(show(0.2f) == doctest::Approx(0.2 * 0.532 / (0.2 * 1.076 + 0.14)).epsilon(1e-6));
  float before = 0;
  for (int k = 1; k < 400; ++k) {
    const float now = show(std::exp2(static_cast<float>(k - 200) / 10));
    CHECK(now >= before);
    CHECK(now <= 1);
    before = now;
  }
  CHECK(show(std::numeric_limits<float>::infinity()) == 1);
  CHECK(show(-3) == 0);
}

TEST_CASE("what is not a number is magenta, by either curve") {
  const std::vector<Rgb> values = {Rgb(0.5f, std::numeric_limits<float>::quiet_NaN(), 0.5f), Rgb(0.5f)};
  for (const Tone* tone : {find_tone("clip"), find_tone("filmic")}) {
    const std::vector<Rgb> shown = expose_values(values, 0, tone);
    CHECK(shown[0] == Rgb(1, 0, 1));
    CHECK(shown[1].g > 0.4f);
  }
}

TEST_CASE("a colour fills what shows nothing of the scene, and its share of a pixel on the border") {
  FilmTable film;
  film.pixel_first = {0, 1, 2, 2};
  film.value = {0, 0};
  film.weight = {1, 0.25f};
  std::vector<Rgb> pixels = {Rgb(0.5f), Rgb(0.125f), Rgb(0)};
  fill_nothing(pixels, film, Rgb(1));
  CHECK(pixels == std::vector<Rgb>{Rgb(0.5f), Rgb(0.875f), Rgb(1)});
}
