// Numbers as colours, and their legend.
#include "tools/image/false_colors.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace patchlight;

namespace {

// `count` values from low to high, by equal ratios.
std::vector<float> make_values(double low, double high, size_t count) {
  std::vector<float> values(count);
  for (size_t k = 0; k < count; ++k)
    values[k] = static_cast<float>(
        low * std::pow(high / low, static_cast<double>(k) / static_cast<double>(count - 1)));
  return values;
}

}  // namespace

TEST_CASE("false colours grow brighter with the value") {
  float before = 0;
  for (int k = 0; k <= 100; ++k) {
    const float now = luminance(map_viridis(k / 100.0));
    CHECK(now > before);
    before = now;
  }
  CHECK(map_viridis(-1) == map_viridis(0));
  CHECK(map_viridis(2) == map_viridis(1));
  // #21918c, the middle of the map.
  CHECK(map_viridis(0.5).g == doctest::Approx(std::pow((0x91 / 255.0 + 0.055) / 1.055, 2.4)).epsilon(1e-5));
}

TEST_CASE("values that lie far apart get a scale by decades, others a linear one from 0") {
  std::vector<float> values = make_values(0.03, 8, 1000);
  const ColorScale wide = pick_radiosity_scale(values, 8, ScaleKind::kAuto);
  CHECK(wide.log);
  CHECK(wide.low == doctest::Approx(0.02));
  CHECK(wide.high == doctest::Approx(10));
  values = make_values(1, 9, 1000);
  const ColorScale narrow = pick_radiosity_scale(values, 8, ScaleKind::kAuto);
  CHECK(!narrow.log);
  CHECK(narrow.low == 0);
  CHECK(narrow.high == doctest::Approx(10));
  CHECK(pick_radiosity_scale(values, 8, ScaleKind::kLog).log);
  // 400 to 480 W/m2: warm walls differ by less than what they send at all.
  values = make_values(400, 480, 1000);
  const ColorScale warm = pick_radiosity_scale(values, 480, ScaleKind::kAuto);
  CHECK(warm.low == doctest::Approx(400));
  CHECK(warm.high == doctest::Approx(480));
}

TEST_CASE("a lamp far brighter than all else lies beyond the scale, and black says nothing") {
  std::vector<float> values = make_values(1, 9, 1000);
  values.insert(values.end(), 500, 0.0f);
  const ColorScale scale = pick_radiosity_scale(values, 5000, ScaleKind::kAuto);
  CHECK(scale.high == doctest::Approx(10));
  CHECK(pick_radiosity_scale(values, 50, ScaleKind::kAuto).high == doctest::Approx(50));
  CHECK(find_position(scale, 5000) == 1);
  std::vector<float> black(10, 0.0f);
  for (const ScaleKind kind : {ScaleKind::kAuto, ScaleKind::kLog, ScaleKind::kLinear}) {
    const ColorScale none = pick_radiosity_scale(black, 0, kind);
    CHECK(none.low < none.high);
    CHECK((!none.log || none.low > 0));
  }
}

TEST_CASE("a value has its place on the scale, and what a pass adds is told on four decades below its top") {
  const ColorScale log{.low = 0.01, .high = 10, .log = true};
  CHECK(find_position(log, 0.01) == 0);
  CHECK(find_position(log, 0.1) == doctest::Approx(1 / 3.0));
  CHECK(find_position(log, 0) == 0);
  CHECK(find_position(log, -1) == 0);
  CHECK(find_position(log, 1e9) == 1);
  const ColorScale linear{.low = 2, .high = 4};
  CHECK(find_position(linear, 2.5) == doctest::Approx(0.25));
  const ColorScale residual = make_added_scale(log, ScaleKind::kAuto);
  CHECK(residual.high == 10);
  CHECK(residual.low == doctest::Approx(0.001));
  CHECK(make_added_scale(log, ScaleKind::kLinear).low == 0);
}

TEST_CASE("ticks are round numbers within the scale, written as people do") {
  CHECK(find_ticks({.low = 0, .high = 10}) == std::vector<double>{0, 2, 4, 6, 8, 10});
  const std::vector<double> ticks = find_ticks({.low = 0.02, .high = 2, .log = true});
  const std::vector<double> expected = {0.02, 0.05, 0.1, 0.2, 0.5, 1, 2};
  REQUIRE(ticks.size() == expected.size());
  for (size_t k = 0; k < ticks.size(); ++k) CHECK(ticks[k] == doctest::Approx(expected[k]));
  CHECK(find_ticks({.low = 1e-3, .high = 10, .log = true}).size() == 5);
  CHECK(format_tick(0) == "0");
  CHECK(format_tick(0.02) == "0.02");
  CHECK(format_tick(1500) == "1500");
  CHECK(format_tick(2e-5) == "2e-5");
  CHECK(format_tick(1e6) == "1e6");
}

TEST_CASE("levels and reasons have a colour each, and what is no number is magenta") {
  Solution solution;
  PatchTable& elements = solution.mesh.elements;
  elements.face = {0, 0, 0};
  elements.level = {0, 2, 3};
  solution.mesh.reasons = {SplitReason::kStart, SplitReason::kBalance};
  const FalseColor& level = *find_false_color("level");
  const ColorScale levels = level.make_scale({}, ScaleKind::kAuto, elements);
  CHECK(levels.classes == std::vector<std::string>{"0", "1", "2", "3"});
  CHECK(level.find_colors(levels, {solution, {}, {}}) ==
        std::vector<Rgb>{map_viridis(0), map_viridis(2 / 3.0), map_viridis(1)});
  const FalseColor& reason = *find_false_color("reason");
  const ColorScale reasons = reason.make_scale({}, ScaleKind::kAuto, elements);
  CHECK(reason.find_colors(reasons, {solution, {}, {}}) == std::vector<Rgb>{map_viridis(0), map_viridis(1)});
  const ColorScale scale{.low = 0, .high = 1};
  const std::vector<Rgb> values = {Rgb(std::numeric_limits<float>::quiet_NaN()), Rgb(0.5f)};
  CHECK(color_luminances(scale, values)[0] == Rgb(1, 0, 1));
  CHECK(color_luminances(scale, values)[1] == map_viridis(0.5));
}

TEST_CASE(
    "a legend shows all colours of its scale at the lower left, and leaves the rest of the picture alone") {
  Picture picture = make_picture(640, 480, Rgb(0.3f));
  draw_legend(picture, {.title = "radiosity, W/m\xc2\xb2", .low = 0.1, .high = 10, .log = true});
  size_t changed_above = 0;
  double nearest_low = 1, nearest_high = 1;
  for (uint32_t y = 0; y < 480; ++y)
    for (uint32_t x = 0; x < 640; ++x) {
      const Rgb pixel = picture.pixels[y * 640 + x];
      if (y < 400) changed_above += pixel != Rgb(0.3f);
      nearest_low = std::min(nearest_low, double{largest(abs(pixel - map_viridis(0)))});
      nearest_high = std::min(nearest_high, double{largest(abs(pixel - map_viridis(1)))});
    }
  CHECK(changed_above == 0);
  // The first and last column of the bar are half a step of 300 from its ends.
  CHECK(nearest_low < 0.01);
  CHECK(nearest_high < 0.01);
  Picture small = make_picture(64, 48, Rgb(0.3f));
  draw_legend(small, find_false_color("reason")->make_scale({}, ScaleKind::kAuto, {}));
  CHECK(small.pixels == make_picture(64, 48, Rgb(0.3f)).pixels);
}
