#include "tests/dsl/support.h"

#include <doctest/doctest.h>

using namespace patchlight;
using namespace patchlight::test;

TEST_CASE("heat: a surface at T emits emissivity sigma T^4 and reflects the rest, in all channels alike") {
  const Loaded loaded = load(
      "patchlight: 1\nmaterials:\n  stove: {temperature: 500, emissivity: 0.8}\n"
      "  mirror: {emissivity: 0.1}\nobjects:\n  - {quad: {size: [1, 1]}, material: stove}\n"
      "  - {quad: {size: [1, 1], center: [0, 1, 0]}, material: mirror}\n");
  REQUIRE(loaded.errors.empty());
  const FaceTable& faces = loaded.scene.faces;
  for (int k = 0; k < 3; ++k) {
    // 5.670374419e-8 (CODATA 2018) times 500^4 times 0.8; columns are floats.
    CHECK(double{faces.emission[0][k]} == doctest::Approx(2835.1872).epsilon(1e-6));
    CHECK(double{faces.reflectance[0][k]} == doctest::Approx(0.2).epsilon(1e-6));
    CHECK(faces.emission[1][k] == 0);
    CHECK(double{faces.reflectance[1][k]} == doctest::Approx(0.9).epsilon(1e-6));
  }
  CHECK(loaded.scene.is_heat);
}

TEST_CASE("a scene with light in it is no scene of heat alone") {
  CHECK_FALSE(load(kBase).scene.is_heat);
  CHECK_FALSE(load("patchlight: 1\nmaterials:\n  stove: {temperature: 500, emissivity: 0.8}\n"
                   "  lamp: {emission: 3}\nobjects:\n  - {quad: {size: [1, 1]}, material: stove}\n"
                   "  - {quad: {size: [1, 1], center: [0, 1, 0]}, material: lamp}\n")
                  .scene.is_heat);
}

TEST_CASE("an emissivity of 0 keeps all heat: a warning") {
  const Loaded loaded = load(
      "patchlight: 1\nmaterials:\n  stove: {temperature: 500, emissivity: 0.8}\n  foil: {emissivity: 0}\n"
      "objects:\n  - {quad: {size: [1, 1]}, material: stove}\n"
      "  - {quad: {size: [1, 1], center: [0, 1, 0]}, material: foil}\n");
  CHECK(loaded.errors.empty());
  CHECK(count_slug(loaded.warnings, "reflectance-one") == 1);
}

TEST_CASE("polygons know the object of the scene's list that they are a part of") {
  const Loaded loaded =
      load(kHead +
           "  - {id: hall, room: {size: [1, 1, 1]}, material: white}\n"
           "  - {quad: {size: [1, 1], center: [0.5, 0.5, 0.5]}, material: lamp}\n"
           "  - {id: pair, group: [{id: a, quad: {size: [0.1, 0.1]}}, {box: {size: [0.1, 0.1, 0.1]}}], "
           "material: white, two_sided: true}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  CHECK(scene.object_ids == std::vector<std::string>{"hall", "object2", "pair"});
  REQUIRE(scene.polygons.object.size() == scene.polygons.size());
  CHECK(scene.polygons.size() == 6 + 1 + 2 + 12);
  for (uint32_t p = 0; p < scene.polygons.size(); ++p)
    CHECK(scene.polygons.object[p] == (p < 6 ? 0u : p < 7 ? 1u : 2u));
}
