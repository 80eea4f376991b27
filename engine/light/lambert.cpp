// Lambert's contour sum, with the polygon clipped at the horizon.
#include "engine/light/lambert.h"

#include <cassert>

namespace patchlight {

double find_point_form_factor(DVec3 point, DVec3 normal, std::span<const Vec3> corners) {
  assert(corners.size() >= 3);
  assert(corners.size() <= 4);
  DVec3 above[8];
  size_t count = 0;
  bool any_above = false;
  for (size_t k = 0; k < corners.size(); ++k) {
    const DVec3 a = DVec3(corners[k]) - point, b = DVec3(corners[(k + 1) % corners.size()]) - point;
    const double height_a = dot(a, normal), height_b = dot(b, normal);
    any_above |= height_a > 0;
    if (height_a >= 0) above[count++] = a;
    if (height_a * height_b < 0) above[count++] = a + (height_a / (height_a - height_b)) * (b - a);
  }
  if (!any_above) return 0;
  // The angle between a and b over its sine, of their cosine c, without an inverse function:
  // sum over n of (2 (1 - c))^n (n!)^2 / (2 n + 1)!. Below 25 degrees nine terms err by 1e-13.
  constexpr double kNarrow = 0.905;
  constexpr double kTerms[9] = {1.0,        1.0 / 6,     1.0 / 30,    1.0 / 140,   1.0 / 630,
                                1.0 / 2772, 1.0 / 12012, 1.0 / 51480, 1.0 / 218790};
  double sum = 0, inverse[8];
  for (size_t k = 0; k < count; ++k) inverse[k] = 1 / length(above[k]);
  for (size_t k = 0; k < count; ++k) {
    const DVec3 a = above[k], b = above[k + 1 == count ? 0 : k + 1];
    const DVec3 across = cross(a, b);
    const double scale = inverse[k] * inverse[k + 1 == count ? 0 : k + 1], cosine = dot(a, b) * scale;
    // Not a number where the point is a corner.
    if (cosine > kNarrow) {
      const double x = 2 * (1 - cosine);
      double ratio = kTerms[8];
      for (size_t n = 8; n-- > 0;) ratio = kTerms[n] + x * ratio;
      sum -= ratio * scale * dot(normal, across);
      continue;
    }
    const double sine = length(across);
    // An edge seen end-on subtends no angle; one that passes through the point has no normal.
    if (sine > 0) sum -= std::atan2(sine, dot(a, b)) / sine * dot(normal, across);
  }
  return std::clamp(sum / (2 * std::numbers::pi), 0.0, 1.0);
}

}  // namespace patchlight
