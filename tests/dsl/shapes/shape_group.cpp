// Groups hand on their transform and their settings.
#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

TEST_CASE("objects of a group take its material, settings and transform, unless they have their own") {
  const Loaded loaded =
      load(kHead +
           "  - id: pair\n    material: white\n    two_sided: true\n    translate: [0, 0, 5]\n    group:\n"
           "      - {quad: {size: [1,1]}}\n"
           "      - {id: lamp, quad: {size: [1,1]}, material: lamp, two_sided: false, translate: [3,0,0]}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  const std::vector<std::string> ids = {"pair.object1", "pair.object1.back", "pair.lamp"};
  CHECK(scene.polygons.id == ids);
  CHECK(corner_in_file(scene, 0, 0).z == doctest::Approx(5.5));
  CHECK(corner_in_file(scene, 2, 0).x == doctest::Approx(2.5));
  CHECK(corner_in_file(scene, 2, 0).z == doctest::Approx(5.5));
  CHECK(scene.faces.emission[0].r == 0);
  CHECK(scene.faces.emission[2].r == 15);
}

}  // namespace
}  // namespace patchlight::test
