// Polygons that lie in one plane: two sides of one sheet, or one of them alone.
#include "dsl/scene/sheets.h"

#include "tests/dsl/support.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <set>

namespace patchlight::test {
namespace {

double area_of(const Scene& scene, const std::string& id) {
  double area = 0;
  for (uint32_t p = 0; p < scene.polygons.size(); ++p)
    for (uint32_t f = scene.polygons.face_first[p]; f < scene.polygons.face_first[p + 1]; ++f)
      if (scene.polygons.id[p] == id) area += face_area(scene, f);
  return area;
}

// The area of a polygon's faces that are one side of a sheet; checks that the other side is the same place.
double sheet_area(const Scene& scene, const std::string& id) {
  const FaceTable& faces = scene.faces;
  double area = 0;
  const auto corners_of = [&](uint32_t f) {
    std::set<std::array<float, 3>> corners;
    for (const Vec3& c : faces.corners[f]) corners.insert({c.x, c.y, c.z});
    return corners;
  };
  for (uint32_t p = 0; p < scene.polygons.size(); ++p)
    for (uint32_t f = scene.polygons.face_first[p]; f < scene.polygons.face_first[p + 1]; ++f) {
      const uint32_t twin = faces.twin[f];
      if (scene.polygons.id[p] != id || twin == kNone) continue;
      area += face_area(scene, f);
      REQUIRE(faces.twin[twin] == f);
      CHECK(corners_of(f) == corners_of(twin));
      CHECK(dot(faces.normal[f], faces.normal[twin]) < -0.999f);
    }
  return area;
}

std::string quad(const std::string& id, double x, double z, double width, double depth, bool up,
                 const std::string& rest = "material: white") {
  const std::string a = "[" + std::to_string(width) + ",0,0]", b = "[0,0," + std::to_string(depth) + "]";
  return "  - {id: " + id + ", quad: {origin: [" + std::to_string(x) + ",0," + std::to_string(z) +
         "], u: " + (up ? b : a) + ", v: " + (up ? a : b) + "}, " + rest + "}\n";
}

Loaded load_quads(const std::string& quads) {
  const std::string above =
      "  - {quad: {center: [0, 9, 0], size: [1, 1], normal: [0, -1, 0]}, material: lamp}\n";
  Loaded loaded = load(kHead + above + quads);
  for (const Diagnostic& error : loaded.errors) MESSAGE(error.message);
  REQUIRE(loaded.errors.empty());
  check_faces(loaded.scene.faces);
  return loaded;
}

// Sizes are of the order of 1 and corners are floats: a few parts in a million.
doctest::Approx about(double value) { return doctest::Approx(value).epsilon(1e-5); }

TEST_CASE("two polygons back to back are the sides of one sheet, and nothing is to be said of them") {
  const Loaded same = load_quads(quad("a", 0, 0, 2, 1, true) + quad("b", 0, 0, 2, 1, false));
  CHECK(count_slug(same.warnings, "coincident") == 0);
  for (const char* id : {"a", "b"}) {
    CHECK(area_of(same.scene, id) == about(2));
    CHECK(sheet_area(same.scene, id) == about(2));
  }
}

TEST_CASE("polygons back to back that overlap in part are cut at each other's outlines") {
  const Loaded part = load_quads(quad("a", 0, 0, 2, 2, true) + quad("b", 1, 1, 2, 2, false) +
                                 quad("c", -1, 0.5, 1.5, 0.25, false));
  CHECK(count_slug(part.warnings, "coincident") == 0);
  CHECK(area_of(part.scene, "a") == about(4));
  CHECK(area_of(part.scene, "b") == about(4));
  CHECK(area_of(part.scene, "c") == about(0.375));
  CHECK(sheet_area(part.scene, "a") == about(1.125));
  CHECK(sheet_area(part.scene, "b") == about(1));
  CHECK(sheet_area(part.scene, "c") == about(0.125));
}

TEST_CASE("slanting outlines and holes are cut, too, and faces of a polygon share whole edges") {
  const std::string star =
      "  - {id: star, polygon: "
      "[[0.5,0,-0.5],[1,0,0.5],[2.5,0,1],[1,0,1.5],[0.5,0,2.5],[0.25,0,1.5],[-0.5,0,1],"
      "[0.25,0,0.5]], holes: [[[0.6,0,0.9],[0.8,0,0.9],[0.7,0,1.1]]], material: white}\n";
  const Loaded loaded = load_quads(quad("a", 0, 0, 2, 2, true) + star);
  CHECK(area_of(loaded.scene, "a") == about(4));
  CHECK(sheet_area(loaded.scene, "a") == about(sheet_area(loaded.scene, "star")));
  CHECK(sheet_area(loaded.scene, "a") > 1);
  // Every edge of a face is shared, or lies on the square's border: two of its ends' coordinates are equal.
  const FaceTable& faces = loaded.scene.faces;
  const FaceLinkTable links = make_surfaces(faces)->links;
  const uint32_t polygon = 1;
  REQUIRE(loaded.scene.polygons.id[polygon] == "a");
  double open = 0;
  for (uint32_t f = loaded.scene.polygons.face_first[polygon];
       f < loaded.scene.polygons.face_first[polygon + 1]; ++f)
    for (uint32_t k = 0; k < faces.corner_count[f]; ++k)
      if (links.edge[f][k].face == kNone)
        open += glm::length(corner_in_file(loaded.scene, f, k) -
                            corner_in_file(loaded.scene, f, (k + 1) % faces.corner_count[f]));
  CHECK(open == about(8));
}

TEST_CASE("of polygons that face one way the smallest is there alone, of equals the last; it is told") {
  const Loaded rug = load_quads(quad("floor", 0, 0, 4, 4, true) + quad("rug", 1, 1, 1, 2, true));
  CHECK(count_slug(rug.warnings, "coincident") == 1);
  CHECK(area_of(rug.scene, "floor") == about(14));
  CHECK(area_of(rug.scene, "rug") == about(2));
  std::string many;
  for (int k = 0; k < 20; ++k) many += quad("q" + std::to_string(k), 0, 0, 1, 1, true);
  const Loaded stack = load_quads(many);
  CHECK(count_slug(stack.warnings, "coincident") >= 1);
  CHECK(area_of(stack.scene, "q18") == 0);
  CHECK(area_of(stack.scene, "q19") == about(1));
  // More edges than are cut at each other.
  const Loaded tower = load_quads(
      "  - {id: t, repeat: {count: 1100, step: [0, 0, 0], of: {quad: {size: [1, 1]}, material: white}}}\n");
  CHECK(area_of(tower.scene, "t[0]") == 0);
  CHECK(area_of(tower.scene, "t[1099]") == about(1));
}

TEST_CASE("a two-sided board on a floor takes the floor's place") {
  const Loaded board = load_quads(quad("floor", 0, 0, 4, 4, true) +
                                  quad("board", 1, 1, 1, 2, true, "two_sided: true, material: white"));
  CHECK(area_of(board.scene, "floor") == about(14));
  CHECK(sheet_area(board.scene, "board") == about(2));
  CHECK(sheet_area(board.scene, "board.back") == about(2));
}

TEST_CASE("a solid on a floor leaves it whole; a room drawn inside of a box of its size does not") {
  const Loaded box = load_quads(quad("floor", 0, 0, 4, 4, true) +
                                "  - {id: b, box: {at: [1, 0, 1], size: [1, 1, 1]}, material: white}\n");
  CHECK(box.scene.polygons.face_first[2] - box.scene.polygons.face_first[1] == 1);
  CHECK(sheet_area(box.scene, "floor") == 0);
  const Loaded house = load_quads(
      "  - {id: shell, box: {size: [4, 2, 2]}, material: white}\n"
      "  - {id: one, room: {size: [2, 2, 2]}, material: white}\n"
      "  - {id: two, room: {at: [2, 0, 0], size: [2, 2, 2]}, material: white}\n");
  CHECK(sheet_area(house.scene, "shell.floor") == about(8));
  CHECK(sheet_area(house.scene, "shell.left") == about(4));
  CHECK(sheet_area(house.scene, "one.right") == about(4));
}

TEST_CASE("no light passes a wall of no thickness, and none is made by surfaces in one place") {
  // Both close within 3e-3 of what is emitted, as other rooms do.
  SUBCASE("two rooms") {
    const Loaded rooms = load(
        "patchlight: 1\nmaterials: {w: {reflectance: 0.5}, l: {reflectance: 0.5, emission: 10}}\nobjects:\n"
        "  - {id: lit, room: {size: [1, 1, 1], walls: {left: l}}, material: w}\n"
        "  - {id: dark, room: {at: [1, 0.2, 0.3], size: [1, 1, 1]}, material: w}\n");
    REQUIRE(rooms.errors.empty());
    const Solution run = solve_scene(rooms.scene.faces, {}, 16);
    CHECK(mean_radiosity(run, rooms.scene.faces, 6, 12) == 0);
    CHECK(find_power_ledger(run).closure_error <= 3e-3);
    CHECK(find_power_ledger(run).escaped.g == 0);
  }
  SUBCASE("twenty floors in one place") {
    const Loaded stack = load(
        "patchlight: 1\nmaterials: {w: {reflectance: 0.5}, l: {reflectance: 0, emission: 10}}\nobjects:\n"
        "  - {room: {size: [1, 1, 1]}, material: w}\n  - repeat: {count: 20, step: [0, 0, 0], of: {quad: "
        "{center: [.5, .3, .5], size: [.5, .5]}, material: w}}\n"
        "  - {quad: {center: [.5, 1, .5], size: [.3, .3], normal: [0, -1, 0]}, material: l}\n");
    REQUIRE(stack.errors.empty());
    CHECK(find_power_ledger(solve_scene(stack.scene.faces, {}, 16)).closure_error <= 3e-3);
  }
}

}  // namespace
}  // namespace patchlight::test
