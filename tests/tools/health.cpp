#include "tools/health.h"

#include "dsl/scene/load.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

constexpr const char* kRoom =
    "patchlight: 1\nunits: cm\nmaterials:\n  white: {reflectance: 0.75}\n"
    "  lamp: {reflectance: 0, emission: 20}\nobjects:\n"
    "  - {id: hall, room: {size: [400, 250, 500], omit: [left]}, material: white}\n"
    "  - {id: lamp, quad: {center: [200, 245, 200], size: [100, 100], normal: [0, -1, 0]}, material: lamp}\n";

Health find_health_of(const std::string& text, Scene& scene) {
  std::vector<Diagnostic> warnings;
  scene = load_scene_text(text, "room.yaml", warnings);
  scene.solver.patch_count_max = 4000;
  const Run run = run_scene(scene.faces, scene.solver, 1);
  return find_health(scene, run.solution, run.tracer);
}

}  // namespace

TEST_CASE(
    "a wall that ends below its ceiling is told, with the edge, its line and its place in the file's units") {
  Scene scene;
  const Health health = find_health_of(
      std::string(kRoom) +
          "  - {id: low, polygon: [[0,0,0],[0,230,0],[0,230,500],[0,0,500]], material: white}\n",
      scene);
  const std::vector<Diagnostic> told = describe_leaks(scene, health.leaks);
  REQUIRE(told.size() == 1);
  CHECK(told[0].severity == Severity::kWarning);
  CHECK(told[0].slug == "light-leak");
  const std::string& words = told[0].message;
  // Rays pass both edges of the gap; either names it.
  const bool wall = words.find("'low' from [0, 230, ") != std::string::npos,
             ceiling = words.find("'hall.ceiling' from [0, 250, ") != std::string::npos;
  CHECK_MESSAGE((wall || ceiling), words);
  CHECK_MESSAGE(words.find(wall ? "(line 9)" : "(line 7)") != std::string::npos, words);
}

TEST_CASE(
    "a closed room is well: rows sum to 1, nothing is told, and reciprocity holds within the rows' noise") {
  Scene scene;
  const Health health = find_health_of(
      std::string(kRoom) +
          "  - {id: left, polygon: [[0,0,0],[0,250,0],[0,250,500],[0,0,500]], material: white}\n",
      scene);
  CHECK(describe_leaks(scene, health.leaks).empty());
  REQUIRE(health.row_sums.size() == 7);
  for (const double sum : health.row_sums) CHECK(sum == 1);
  REQUIRE(health.reciprocity_errors.size() == 7);
  // The lamp is one to four patches of 256 rays: its factor to a wall errs by up to 1 / (2 sqrt(256)) = 3 %,
  // and the walls' rows, which meet it rarely, by as much in proportion.
  for (const double error : health.reciprocity_errors) CHECK(error <= 0.06);
}
