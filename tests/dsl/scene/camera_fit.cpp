// The automatic camera has the scene in its picture.
#include "dsl/scene/camera_fit.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace patchlight::test {
namespace {

// Largest picture coordinate of a point, 1 at the border; above 1e30 behind the camera.
double picture_coordinate(const Camera& camera, DVec3 point) {
  const DVec3 view = glm::normalize(camera.target - camera.eye),
              right = glm::normalize(glm::cross(view, camera.up)), up = glm::cross(right, view),
              offset = point - camera.eye;
  const double depth = glm::dot(offset, view), tan_y = std::tan(camera.fov_degrees * std::numbers::pi / 360);
  if (depth <= 0) return 1e300;
  const double tan_x = tan_y * camera.width / camera.height;
  return std::max(std::abs(glm::dot(offset, right)) / depth / tan_x,
                  std::abs(glm::dot(offset, up)) / depth / tan_y);
}

TEST_CASE("a room fills the picture of the automatic camera, and a far sun does not shrink it") {
  const std::string room = "  - {room: {size: [6,3,7]}, material: white}\n";
  const std::string sun =
      "  - {quad: {center: [500,300,0], size: [5,5], normal: [-1,-1,0]}, material: lamp}\n";
  for (const std::string& text : {kHead + room, kHead + room + sun}) {
    const Loaded loaded = load(text);
    REQUIRE(loaded.errors.empty());
    const Scene& scene = loaded.scene;
    REQUIRE(scene.cameras.size() == 1);
    double most = 0;
    for (uint32_t f = 0; f < scene.faces.size(); ++f)
      if (scene.faces.emission[f].r <= 0)
        for (const Vec3& c : scene.faces.corners[f])
          most = std::max(most, picture_coordinate(scene.cameras[0], DVec3(c)));
    CHECK(most <= 1);
    CHECK(most > 0.8);
  }
}

TEST_CASE("a room that is open on one side is looked at from there") {
  const Loaded loaded = load(kHead + "  - {room: {size: [5,5,5], omit: [back]}, material: white}\n");
  REQUIRE(loaded.errors.empty());
  const Camera& camera = loaded.scene.cameras[0];
  CHECK(camera.eye.z < camera.target.z);
}

}  // namespace
}  // namespace patchlight::test
