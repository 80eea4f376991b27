// Convex polygons with many corners (discs) to rings of triangles.
#include "dsl/polygons/cut.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

constexpr size_t kCornersMin = 7;      // fewer are cut without points inside
constexpr double kRoundnessMin = 0.7;  // 4 pi area / perimeter squared: 1 for a circle
constexpr double kEdgeMax = 2.5;       // longest edge against the mean one

bool is_roundish(const FlatPolygon& polygon) {
  const size_t count = polygon.flat.size();
  if (polygon.ring_count() != 1 || count < kCornersMin) return false;
  double perimeter = 0, longest = 0;
  for (size_t k = 0; k < count; ++k) {
    const DVec2 a = polygon.flat[k], b = polygon.flat[(k + 1) % count], c = polygon.flat[(k + 2) % count];
    if (turn(a, b, c) < -1e-12) return false;
    perimeter += glm::length(b - a);
    longest = std::max(longest, glm::length(b - a));
  }
  return 4 * std::numbers::pi * polygon.area / (perimeter * perimeter) > kRoundnessMin &&
         longest < kEdgeMax * perimeter / static_cast<double>(count);
}

}  // namespace

bool cut_rings(const FlatPolygon& polygon, std::vector<DVec2>& flat, CutFaces& cut) {
  if (!is_roundish(polygon)) return false;
  flat = polygon.flat;
  const DVec2 centre = polygon.centroid;
  const auto add_point = [&](DVec2 p) {
    flat.push_back(p);
    cut.points.push_back(point_at(polygon, p));
    return static_cast<uint32_t>(flat.size() - 1);
  };
  const auto add_triangle = [&](uint32_t a, uint32_t b, uint32_t c) { cut.faces.push_back({a, b, c, c}); };
  std::vector<uint32_t> outer(polygon.flat.size());
  for (uint32_t k = 0; k < outer.size(); ++k) outer[k] = k;
  // Each ring lies one edge length further in, and has a corner for every second one of the ring before.
  while (outer.size() > 12) {
    const size_t count = outer.size(), inner_count = (count + 1) / 2;
    double perimeter = 0, radius = 0;
    for (size_t k = 0; k < count; ++k) {
      perimeter += glm::length(flat[outer[(k + 1) % count]] - flat[outer[k]]);
      radius += glm::length(flat[outer[k]] - centre) / static_cast<double>(count);
    }
    const double scale = std::max(0.5, 1 - 1.5 * perimeter / static_cast<double>(count) / radius);
    std::vector<uint32_t> inner(inner_count);
    for (size_t k = 0; k < inner_count; ++k)
      inner[k] = add_point(centre + (flat[outer[2 * k]] - centre) * scale);
    for (size_t k = 0; k < inner_count; ++k) {
      const uint32_t a = inner[k], b = inner[(k + 1) % inner_count];
      const uint32_t p = outer[2 * k], q = outer[(2 * k + 1) % count];
      add_triangle(p, q, a);
      add_triangle(a, q, b);
      if (2 * k + 1 < count) add_triangle(q, outer[(2 * k + 2) % count], b);
    }
    outer = std::move(inner);
  }
  const uint32_t middle = add_point(centre);
  for (size_t k = 0; k < outer.size(); ++k) add_triangle(middle, outer[k], outer[(k + 1) % outer.size()]);
  return true;
}

}  // namespace patchlight
