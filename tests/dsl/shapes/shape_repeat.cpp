// Repeats in rows, by a transform, and with their index.
#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

DVec3 middle(const Scene& scene, size_t face) {
  return (corner_in_file(scene, face, 0) + corner_in_file(scene, face, 2)) * 0.5;
}

TEST_CASE("copies in rows along each axis") {
  const Loaded loaded = load(
      kHead +
      "  - {id: r, repeat: {count: [2,1,3], step: [2,1,4], of: {quad: {size: [1,1]}, material: lamp}}}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  const std::vector<std::string> ids = {"r[0,0,0]", "r[1,0,0]", "r[0,0,1]",
                                        "r[1,0,1]", "r[0,0,2]", "r[1,0,2]"};
  CHECK(scene.polygons.id == ids);
  CHECK(glm::length(middle(scene, 5) - DVec3(2, 0, 8)) < 1e-6);
}

TEST_CASE("copies along one step, and by a transform applied again and again") {
  const Loaded row =
      load(kHead + "  - {repeat: {count: 3, step: [1,2,0], of: {quad: {size: [1,1]}, material: lamp}}}\n");
  REQUIRE(row.errors.empty());
  CHECK(row.scene.polygons.id[2] == "object1[2]");
  CHECK(glm::length(middle(row.scene, 2) - DVec3(2, 4, 0)) < 1e-6);
  const Loaded ring = load(kHead +
                           "  - {repeat: {count: 4, transform: [{rotate: {axis: y, angle: 90}}], of: {quad: "
                           "{center: [3,0,0], size: [1,1]}, material: lamp}}}\n");
  REQUIRE(ring.errors.empty());
  CHECK(glm::length(middle(ring.scene, 1) - DVec3(0, 0, -3)) < 1e-6);
  CHECK(glm::length(middle(ring.scene, 2) - DVec3(-3, 0, 0)) < 1e-6);
}

TEST_CASE("the index of a copy is $i, $j, $k; an inner repeat hides the outer one's") {
  const Loaded loaded = load(kHead +
                             "  - {repeat: {count: [2,1,1], step: [10,0,0], of: {repeat: {count: 2, step: "
                             "[0,5,0], of: {id: q, quad: {size: ['=1+$i', '=1+$j']}, material: lamp}}}}}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  CHECK(scene.polygons.id[3] == "object1[1,0,0][1].q");
  CHECK(face_area(scene, 0) == doctest::Approx(1));
  double area = 0;
  for (uint32_t f = scene.polygons.face_first[3]; f < scene.polygons.face_first[4]; ++f)
    area += face_area(scene, f);
  CHECK(area == doctest::Approx(2));
}

}  // namespace
}  // namespace patchlight::test
