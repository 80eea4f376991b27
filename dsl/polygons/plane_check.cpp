// Which corners of a polygon spoil its plane.
#include "dsl/polygons/plane_check.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr size_t kBlameMax = 64;  // rings with more corners are not searched for the one to blame

}  // namespace

DVec3 newell(const std::vector<DVec3>& points, size_t first, size_t last, DVec3 origin, double size,
             size_t skip) {
  DVec3 sum(0);
  size_t before = last - 1 == skip ? last - 2 : last - 1;
  for (size_t k = first; k < last; ++k) {
    if (k == skip) continue;
    sum += glm::cross((points[before] - origin) / size, (points[k] - origin) / size);
    before = k;
  }
  return sum;
}

size_t corner_to_blame(const FlatPolygon& polygon) {
  const size_t count = polygon.ring_first[1];
  size_t worst = 0;
  double worst_rest = 1e300, worst_distance = 0;
  for (size_t k = 0; k < count; ++k) {
    if (count > kBlameMax) {
      const double distance = std::abs(glm::dot(polygon.points[k] - polygon.origin, polygon.normal));
      if (distance > worst_distance) worst = k, worst_distance = distance;
      continue;
    }
    const DVec3 normal_sum = newell(polygon.points, 0, count, polygon.origin, polygon.size, k);
    if (glm::length(normal_sum) < kAreaMin) continue;
    const DVec3 normal = glm::normalize(normal_sum);
    DVec3 middle(0);
    for (size_t j = 0; j < count; ++j)
      if (j != k) middle += (polygon.points[j] - polygon.origin) / static_cast<double>(count - 1);
    double rest = 0;
    for (size_t j = 0; j < count; ++j)
      if (j != k)
        rest = std::max(rest, std::abs(glm::dot(polygon.points[j] - polygon.origin - middle, normal)));
    const double distance = std::abs(glm::dot(polygon.points[k] - polygon.origin - middle, normal));
    const double tie = 1e-9 * polygon.size;
    if (rest < worst_rest - tie || (rest < worst_rest + tie && distance > worst_distance)) {
      worst = k;
      worst_rest = rest;
      worst_distance = distance;
    }
  }
  return worst;
}

bool is_on_line(const FlatPolygon& polygon) {
  const DVec3 first = polygon.points[0];
  DVec3 far(0);
  for (const DVec3& point : polygon.points)
    if (glm::length(point - first) > glm::length(far)) far = point - first;
  const DVec3 along = glm::normalize(far / polygon.size);
  for (const DVec3& point : polygon.points)
    if (glm::length(glm::cross((point - first) / polygon.size, along)) > kAreaMin) return false;
  return true;
}

uint32_t ring_off_plane(const FlatPolygon& polygon) {
  uint32_t worst_ring = 0;
  double worst = 0;
  for (uint32_t ring = 0; ring < polygon.ring_count(); ++ring)
    for (uint32_t k = polygon.ring_first[ring]; k < polygon.ring_first[ring + 1]; ++k) {
      const double distance =
          std::abs(glm::dot((polygon.points[k] - polygon.origin) / polygon.size, polygon.normal));
      if (distance > worst) worst = distance, worst_ring = ring;
    }
  return worst_ring;
}

}  // namespace patchlight
