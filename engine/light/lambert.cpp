// Lambert's contour sum, with the polygon clipped at the horizon.
#include "engine/light/lambert.h"

#include <cassert>

namespace patchlight {

double find_point_form_factor(DVec3 point, DVec3 normal, std::span<const Vec3> corners) {
  assert(corners.size() >= 3);
  assert(corners.size() <= 4);
  DVec3 above[8];
  size_t count = 0;
  for (size_t k = 0; k < corners.size(); ++k) {
    const DVec3 a = DVec3(corners[k]) - point, b = DVec3(corners[(k + 1) % corners.size()]) - point;
    const double height_a = dot(a, normal), height_b = dot(b, normal);
    if (height_a >= 0) above[count++] = a;
    if (height_a * height_b < 0) above[count++] = a + (height_a / (height_a - height_b)) * (b - a);
  }
  double sum = 0;
  for (size_t k = 0; k < count; ++k) {
    const DVec3 a = above[k], b = above[k + 1 == count ? 0 : k + 1];
    const DVec3 across = cross(a, b);
    const double sine = length(across);
    // An edge seen end-on subtends no angle; one that passes through the point has no normal.
    if (sine > 0) sum -= std::atan2(sine, dot(a, b)) / sine * dot(normal, across);
  }
  return std::clamp(sum / (2 * std::numbers::pi), 0.0, 1.0);
}

}  // namespace patchlight
