// Transforms: their order, mirrors, groups.
#include "dsl/shapes/transform.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

// A square of side 2 around the origin that faces up, moved as `keys` say.
Loaded moved_square(const std::string& keys) {
  return load(kHead + "  - {quad: {size: [2, 2]}, material: lamp, " + keys + "}\n");
}

DVec3 middle(const Scene& scene, size_t face) {
  return (corner_in_file(scene, face, 0) + corner_in_file(scene, face, 2)) * 0.5;
}

TEST_CASE("steps are applied in their order") {
  const Loaded turned_last =
      moved_square("transform: [{translate: [3,0,0]}, {rotate: {axis: y, angle: 90}}]");
  REQUIRE(turned_last.errors.empty());
  CHECK(glm::length(middle(turned_last.scene, 0) - DVec3(0, 0, -3)) < 1e-6);
  const Loaded turned_first =
      moved_square("transform: [{rotate: {axis: y, angle: 90}}, {translate: [3,0,0]}]");
  CHECK(glm::length(middle(turned_first.scene, 0) - DVec3(3, 0, 0)) < 1e-6);
}

TEST_CASE("the short keys scale, then rotate, then translate") {
  const Loaded loaded =
      moved_square("translate: [1,2,3], rotate: {axis: [0,0,5], angle: 90}, scale: [2,1,1]");
  REQUIRE(loaded.errors.empty());
  CHECK(glm::length(middle(loaded.scene, 0) - DVec3(1, 2, 3)) < 1e-6);
  CHECK(glm::length(loaded.scene.faces.normal[0] - Vec3(-1, 0, 0)) < 1e-6f);
  CHECK(face_area(loaded.scene, 0) + (loaded.scene.faces.size() > 1 ? face_area(loaded.scene, 1) : 0) ==
        doctest::Approx(8));
}

TEST_CASE("a mirror keeps the lit side lit") {
  const Loaded loaded = moved_square("scale: [-1,1,1]");
  REQUIRE(loaded.errors.empty());
  CHECK(loaded.scene.faces.normal[0].y == doctest::Approx(1));
  const Loaded box =
      load(kHead + "  - {box: {at: [1,1,1], size: [1,1,1]}, material: lamp, scale: [1,-2,1]}\n");
  REQUIRE(box.errors.empty());
  const DVec3 centre(1.5, -3, 1.5);
  for (size_t f = 0; f < box.scene.faces.size(); ++f)
    CHECK(glm::dot(corner_in_file(box.scene, f, 0) - centre, DVec3(box.scene.faces.normal[f])) > 0);
}

TEST_CASE("quarter turns are exact") {
  const Loaded loaded = moved_square("rotate: {axis: x, angle: -90}, translate: [0,0,7]");
  REQUIRE(loaded.errors.empty());
  for (size_t k = 0; k < 4; ++k) CHECK(corner_in_file(loaded.scene, 0, k).z == 7);
}

}  // namespace
}  // namespace patchlight::test
