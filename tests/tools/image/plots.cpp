// Drawings of how a run went.
#include "tools/image/plots.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>

using namespace patchlight;

namespace {

size_t count_parts(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::vector<PassReport> make_passes(size_t count, double first, double ratio, double unshot_ratio) {
  std::vector<PassReport> passes(count);
  double power = first;
  for (size_t k = 0; k < count; ++k, power *= ratio) {
    passes[k].pass = static_cast<uint32_t>(k + 1);
    passes[k].added_power = DRgb(power);
    passes[k].unshot_power = DRgb(power * unshot_ratio);
  }
  return passes;
}

// The y of all points of the first curve.
std::vector<double> read_heights(const std::string& svg) {
  std::vector<double> heights;
  size_t at = svg.find("points=\"") + 8;
  const size_t end = svg.find('"', at);
  while ((at = svg.find(',', at)) < end) heights.push_back(std::atof(svg.c_str() + ++at));
  return heights;
}

}  // namespace

TEST_CASE("a power that falls by one ratio is a straight line, by decades") {
  const std::string svg =
      plot_convergence(make_passes(9, 200, 0.5, 1), {.title = "a < b & c", .step = "pass", .until = 0.01});
  CHECK(svg.starts_with("<svg "));
  CHECK(svg.ends_with("</svg>\n"));
  CHECK(svg.find("a &lt; b &amp; c") != std::string::npos);
  CHECK(svg.find("until: 1 % of pass 1") != std::string::npos);
  CHECK(count_parts(svg, "<polyline") == 1);
  const std::vector<double> heights = read_heights(svg);
  REQUIRE(heights.size() == 9);
  // Written with one decimal.
  for (size_t k = 1; k + 1 < heights.size(); ++k)
    CHECK(std::abs(heights[k + 1] - 2 * heights[k] + heights[k - 1]) <= 0.21);
  CHECK(heights[1] > heights[0]);
  // 200 W is drawn a decade and a half above 0.78 W, as the grid says: 1 kW to 100 mW.
  for (const char* label : {">1 kW<", ">100 W<", ">1 W<", ">100 mW<"})
    CHECK(svg.find(label) != std::string::npos);
}

TEST_CASE(
    "what is unshot has a curve of its own where it is not what the step added; long runs are thinned") {
  const std::string svg =
      plot_convergence(make_passes(5000, 10, 0.999, 30), {.title = "shots", .step = "shot"});
  CHECK(count_parts(svg, "<polyline") == 2);
  CHECK(svg.find("not sent on yet") != std::string::npos);
  CHECK(read_heights(svg).size() < 500);
  CHECK(svg.size() < 60'000);
}

TEST_CASE("runs of no pass, one pass and no light are drawn, too") {
  for (const size_t count : {0, 1, 2}) {
    const std::string svg = plot_convergence(make_passes(count, 0, 1, 1), {.title = "dark", .step = "pass"});
    CHECK(svg.ends_with("</svg>\n"));
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("inf") == std::string::npos);
  }
  CHECK(plot_rounds({}, {.title = "none", .step = "pass"}).ends_with("</svg>\n"));
}

TEST_CASE("rounds are bars with their numbers of patches") {
  std::vector<RoundReport> rounds(3);
  for (size_t k = 0; k < 3; ++k) rounds[k].patch_count = 1000 * (k + 1);
  const std::string svg = plot_rounds(rounds, {.title = "room", .step = "pass"});
  CHECK(count_parts(svg, "fill=\"#21618c\"") == 3);
  for (const char* label : {">1000<", ">2000<", ">3000<"}) CHECK(svg.find(label) != std::string::npos);
}
