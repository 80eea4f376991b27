// Cameras as they arrive in the scene.
#include "dsl/scene/cameras.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

TEST_CASE("a camera may have any projection of the engine's table; the first one where it names none") {
  const std::string camera = kBase + "camera: {eye: [0,0,3], target: [0,0,0]";
  for (const Projection& projection : projections()) {
    CAPTURE(projection.name);
    const Loaded loaded = load(camera + ", projection: " + std::string(projection.name) + "}\n");
    REQUIRE(loaded.errors.empty());
    CHECK(loaded.scene.cameras[0].projection == &projection);
  }
  CHECK(load(camera + "}\n").scene.cameras[0].projection == &projections()[0]);
  CHECK(load(kBase).scene.cameras[0].projection == &projections()[0]);
}

}  // namespace
}  // namespace patchlight::test
