// What a scene expects beside what a solution shows.
#include "expectations.h"

#include "dsl/report/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

double largest_difference(const Expectation& expectation, const DRgb& found) {
  const DRgb difference = found - DRgb(expectation.radiosity);
  return std::max({std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)});
}

std::string rgb_text(const DRgb& rgb) { return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", rgb.r, rgb.g, rgb.b); }

}  // namespace

DRgb find_mean_radiosity(const Solution& solution, const Scene& scene, const Expectation& expectation) {
  DRgb sum(0);
  double area = 0;
  const PatchTable& elements = solution.elements;
  for (const uint32_t polygon : expectation.polygons)
    for (uint32_t f = scene.polygons.face_first[polygon]; f < scene.polygons.face_first[polygon + 1]; ++f)
      for (uint32_t row = elements.face_first[f]; row < elements.face_first[f + 1]; ++row) {
        const double exposed_area = double{elements.area[row]} * elements.exposed[row];
        sum += exposed_area * DRgb(elements.radiosity[row]);
        area += exposed_area;
      }
  return area > 0 ? sum / area : sum;
}

bool is_met(const Expectation& expectation, const DRgb& found) {
  return largest_difference(expectation, found) <= expectation.tolerance * largest(expectation.radiosity);
}

std::string describe_result(const Expectation& expectation, const DRgb& found) {
  const double scale = largest(expectation.radiosity);
  return fmt::format(
      "{}, pass {}: expected {} within {:g} %, found {}{}", escape_text(expectation.object), expectation.pass,
      rgb_text(DRgb(expectation.radiosity)), expectation.tolerance * 100, rgb_text(found),
      scale > 0 ? fmt::format(", off by {:.2g} %", 100 * largest_difference(expectation, found) / scale)
                : "");
}

}  // namespace patchlight
