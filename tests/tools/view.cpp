// Places on polygons that patches look out from. Whole runs are in program/pictures.cpp.
#include "tools/view.h"

#include "dsl/report/diagnostics.h"
#include "dsl/scene/load.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

Scene load(const std::string& objects) {
  std::vector<Diagnostic> warnings;
  return load_scene_text(
      "patchlight: 1\nmaterials:\n  lamp: {reflectance: 0.5, emission: 1}\nobjects:\n" + objects, "t.yaml",
      warnings, {});
}

// In the file's units.
DVec3 find_point(const Scene& scene, const std::string& polygon, double u, double v) {
  const PatchPlace place = find_patch_place(scene, {.polygon = polygon, .u = u, .v = v});
  return scene.origin + DVec3(place.point) * scene.units_per_length;
}

void check_near(DVec3 found, DVec3 expected) {
  for (int k = 0; k < 3; ++k) CHECK(std::abs(found[k] - expected[k]) < 1e-5);
}

std::string find_mistake(const Scene& scene, const ViewOptions& view) {
  try {
    find_patch_place(scene, view);
  } catch (const UserError& error) {
    return error.diagnostics.front().slug + ": " + error.diagnostics.front().message;
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A wall of 4 x 2 with a window in its middle; its first edge runs along x.
const char* const kWall =
    "  - {id: wall, polygon: [[0,0,0],[4,0,0],[4,2,0],[0,2,0]], holes: "
    "[[[1,0.5,0],[3,0.5,0],[3,1.5,0],[1,1.5,0]]], "
    "material: lamp}\n";

}  // namespace

TEST_CASE("u runs along the first edge of a polygon and v across, whatever pieces it was cut into") {
  const Scene wall = load(kWall);
  REQUIRE(wall.faces.size() > 1);
  check_near(find_point(wall, "wall", 0.125, 0.75), {0.5, 1.5, 0});
  const Scene turned = load("  - {id: tall, polygon: [[1,0,0],[1,3,0],[0,3,0],[0,0,0]], material: lamp}\n");
  check_near(find_point(turned, "tall", 0.5, 0.25), {0.75, 1.5, 0});
  // A triangle that leans: its rectangle reaches beyond its first edge.
  const Scene leaning = load("  - {id: sail, polygon: [[0,0,0],[2,0,0],[4,2,0]], material: lamp}\n");
  check_near(find_point(leaning, "sail", 0.5, 0.25), {2, 0.5, 0});
}

TEST_CASE("the place knows the side that is lit") {
  const Scene wall = load(kWall);
  CHECK(find_patch_place(wall, {.polygon = "wall", .u = 0.1, .v = 0.1}).normal == Vec3(0, 0, 1));
}

TEST_CASE("places in holes, polygons that are not there and objects of several are told") {
  const Scene wall = load(kWall);
  CHECK(has(find_mistake(wall, {.polygon = "wall", .u = 0.5, .v = 0.5}),
            "usage: --from: 0.5,0.5 lies outside of 'wall'"));
  CHECK(has(find_mistake(wall, {.polygon = "wal", .u = 0.1, .v = 0.1}), "did you mean 'wall'?"));
  const Scene box = load("  - {id: box, box: {size: [1, 1, 1]}, material: lamp}\n");
  CHECK(has(find_mistake(box, {.polygon = "box", .u = 0.1, .v = 0.1}), "its parts have names such as 'box."));
}
