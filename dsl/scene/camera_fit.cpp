// A camera for scenes that name none.
#include "dsl/scene/camera_fit.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kFarAway = 1.5;  // emitters farther than this many diagonals from the rest are left out
constexpr double kMargin = 1.04;  // room around the scene in the picture
constexpr double kAsGood = 0.97;  // share of the best direction's lit area that an earlier one may have

struct Bounds {
  DVec3 low{1e300}, high{-1e300};
  bool empty() const { return low.x > high.x; }
};

void grow(Bounds& bounds, const std::array<Vec3, 4>& corners) {
  for (const Vec3& c : corners) {
    bounds.low = glm::min(bounds.low, DVec3(c));
    bounds.high = glm::max(bounds.high, DVec3(c));
  }
}

// The box around what is worth seeing, and which faces those are.
Bounds find_bounds(const FaceTable& faces, std::vector<uint8_t>& seen) {
  seen.assign(faces.size(), 0);
  Bounds bounds;
  for (size_t f = 0; f < faces.size(); ++f)
    if (largest(faces.emission[f]) <= 0) grow(bounds, faces.corners[f]), seen[f] = 1;
  const Bounds dark = bounds;
  for (size_t f = 0; f < faces.size(); ++f) {
    if (seen[f]) continue;
    const DVec3 middle = DVec3(faces.corners[f][0] + faces.corners[f][2]) * 0.5;
    const bool far = !dark.empty() && glm::length(middle - glm::clamp(middle, dark.low, dark.high)) >
                                          kFarAway * glm::length(dark.high - dark.low);
    if (!far) grow(bounds, faces.corners[f]), seen[f] = 1;
  }
  return bounds;
}

// Lit area that faces a direction.
double facing_area(const FaceTable& faces, const std::vector<uint8_t>& seen, DVec3 towards) {
  double sum = 0;
  for (size_t f = 0; f < faces.size(); ++f) {
    if (!seen[f]) continue;
    const auto& c = faces.corners[f];
    const double area =
        glm::length(glm::cross(DVec3(c[2] - c[0]), DVec3(c[3] - c[1]))) / 2 +
        (faces.corner_count[f] == 3 ? glm::length(glm::cross(DVec3(c[1] - c[0]), DVec3(c[2] - c[0]))) / 2
                                    : 0);
    sum += area * std::max(0.0, glm::dot(DVec3(faces.normal[f]), towards));
  }
  return sum;
}

}  // namespace

Camera fit_camera(const FaceTable& faces) {
  Camera camera;
  camera.up = DVec3(0, 1, 0);
  camera.fov_degrees = 45;
  std::vector<uint8_t> seen;
  const Bounds bounds = find_bounds(faces, seen);
  // From the front, from half left and right, and so on around; level with a little height first.
  DVec3 best(0, 0, 1);
  double best_area = -1;
  for (const double height : {0.15, 0.8, -0.5})
    for (const double degrees : {12.0, -12.0, 35.0, -35.0, 168.0, -168.0, 90.0, -90.0, 145.0, -145.0}) {
      const double angle = degrees * std::acos(-1.0) / 180;
      const DVec3 towards = glm::normalize(DVec3(std::sin(angle), height, std::cos(angle)));
      const double area = facing_area(faces, seen, towards);
      if (area * kAsGood <= best_area) continue;
      best_area = area;
      best = towards;
    }
  // As near as all corners of the box allow.
  const DVec3 middle = (bounds.low + bounds.high) * 0.5;
  const DVec3 right = glm::normalize(glm::cross(camera.up, best)), above = glm::cross(best, right);
  const double tan_y = std::tan(camera.fov_degrees * std::acos(-1.0) / 360) / kMargin;
  const double tan_x = tan_y * camera.width / camera.height;
  double distance = 0;
  for (int k = 0; k < 8; ++k) {
    const DVec3 corner = DVec3(k & 1 ? bounds.high.x : bounds.low.x, k & 2 ? bounds.high.y : bounds.low.y,
                               k & 4 ? bounds.high.z : bounds.low.z) -
                         middle;
    const double side =
        std::max(std::abs(glm::dot(corner, right)) / tan_x, std::abs(glm::dot(corner, above)) / tan_y);
    distance = std::max(distance, side + glm::dot(corner, best));
  }
  camera.target = middle;
  camera.eye = middle + best * (distance > 0 ? distance : 1);
  return camera;
}

}  // namespace patchlight
