// Cameras, solver and output as they arrive in the scene.
#include "dsl/scene/settings.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

TEST_CASE("defaults are those of the engine") {
  const Loaded loaded = load(kBase + "solver: {}\noutput: {}\n");
  REQUIRE(loaded.errors.empty());
  const SolverSettings built_in, &read = loaded.scene.solver;
  CHECK(read.pass_count_max == built_in.pass_count_max);
  CHECK(read.until == built_in.until);
  CHECK(read.patch_size == built_in.patch_size);
  CHECK(read.patch_size_min == built_in.patch_size_min);
  CHECK(read.threshold == built_in.threshold);
  CHECK(read.patch_count_max == built_in.patch_count_max);
  CHECK(read.rays == built_in.rays);
  CHECK(read.seed == built_in.seed);
  CHECK(loaded.scene.output.snapshots.empty());
  CHECK(!loaded.scene.output.exposure_ev);
  CHECK(loaded.scene.units == "m");
}

TEST_CASE("settings are read") {
  const Loaded loaded =
      load(kBase +
           "title: A room\nunits: ft\nsolver: {passes: 4, until: 0, threshold: 0.5, rays: 64, seed: 9, "
           "max_patches: 1000}\n"
           "output: {snapshots: [4, 1, 1], exposure: -2.5, shading: flat, basename: room}\n"
           "cameras:\n  - {name: a, eye: [0,0,3], target: [0,0,0], fov: 40, size: [64, 48]}\n"
           "  - {name: b, eye: [3,0,0], target: [0,0,0], up: [0,0,1]}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  CHECK(scene.title == "A room");
  CHECK(scene.metres_per_unit == 0.3048);
  CHECK(scene.solver.pass_count_max == 4);
  CHECK(scene.solver.until == 0);
  CHECK(scene.solver.patch_count_max == 1000);
  CHECK(scene.output.snapshots == std::vector<uint32_t>{1, 4});
  CHECK(scene.output.exposure_ev.value() == -2.5);
  CHECK(scene.output.shading == Shading::kFlat);
  CHECK(scene.output.basename == "room");
  REQUIRE(scene.cameras.size() == 2);
  CHECK(scene.cameras[0].fov_degrees == 40);
  CHECK(scene.cameras[0].width == 64);
  CHECK(scene.cameras[1].name == "b");
}

}  // namespace
}  // namespace patchlight::test
