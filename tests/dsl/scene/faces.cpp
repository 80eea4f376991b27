// Polygons to the engine's faces: units, order of corners, twins, levels, identity of shared corners.
#include "dsl/scene/faces.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <set>
#include <tuple>

namespace patchlight::test {
namespace {

double total_area(const Scene& scene) {
  double sum = 0;
  for (size_t f = 0; f < scene.faces.size(); ++f) sum += face_area(scene, f);
  return sum;
}

std::tuple<float, float, float> key(Vec3 p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

TEST_CASE("the root of the scene's area is 1 to 2 engine lengths, whatever the file's unit") {
  for (const double scale : {1e-9, 1e-3, 1.0, 37.0, 1e6, 1e14}) {
    CAPTURE(scale);
    const Loaded loaded =
        load(kHead + fmt::format("  - {{room: {{size: [{0}, {0}, {0}]}}, material: white}}\n", scale));
    REQUIRE(loaded.errors.empty());
    const Scene& scene = loaded.scene;
    REQUIRE(scene.faces.size() == 6);
    const double root = std::sqrt(total_area(scene)) / scene.units_per_length;
    CHECK(root >= 1);
    CHECK(root < 2);
    for (const Vec3& normal : scene.faces.normal)
      CHECK(glm::length(normal) == doctest::Approx(1).epsilon(1e-6));
    CHECK(total_area(scene) == doctest::Approx(6 * scale * scale).epsilon(1e-5));
  }
}

TEST_CASE("corners run counter-clockwise seen from the normal") {
  const Loaded loaded = load(kBase +
                             "  - {box: {size: [1,2,3]}, material: white}\n  - {room: {at: [5,5,5], size: "
                             "[1,2,3]}, material: white}\n");
  REQUIRE(loaded.errors.empty());
  const FaceTable& faces = loaded.scene.faces;
  for (size_t f = 0; f < faces.size(); ++f) {
    const auto& c = faces.corners[f];
    CHECK(glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), faces.normal[f]) > 0);
  }
}

TEST_CASE("a box faces outward, a room inward, and the eight corners are the same bits for all sides") {
  for (const bool room : {false, true}) {
    const Loaded loaded = load(kHead + "  - {" + (room ? "room" : "box") +
                               ": {at: [0.1, 0.2, 0.3], size: [1.1, 1.2, 1.3]}, material: white}\n");
    REQUIRE(loaded.errors.empty());
    const FaceTable& faces = loaded.scene.faces;
    REQUIRE(faces.size() == 6);
    std::set<std::tuple<float, float, float>> corners;
    for (size_t f = 0; f < 6; ++f) {
      for (const Vec3& c : faces.corners[f]) corners.insert(key(c));
      // The scene's origin is the box's middle.
      CHECK((glm::dot(faces.corners[f][0], faces.normal[f]) < 0) == room);
    }
    CHECK(corners.size() == 8);
    const std::vector<std::string> ids = {"object1.floor", "object1.ceiling", "object1.left",
                                          "object1.right", "object1.front",   "object1.back"};
    CHECK(loaded.scene.polygons.id == ids);
  }
}

TEST_CASE("sides lie where their names say") {
  const Loaded loaded = load(kHead + "  - {id: b, box: {size: [2,2,2], at: [-1,-1,-1]}, material: white}\n");
  REQUIRE(loaded.errors.empty());
  const std::vector<Vec3> expected = {Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0),
                                      Vec3(1, 0, 0),  Vec3(0, 0, 1), Vec3(0, 0, -1)};
  for (size_t f = 0; f < 6; ++f) CHECK(glm::length(loaded.scene.faces.normal[f] - expected[f]) < 1e-6f);
}

TEST_CASE("a two-sided polygon has twins back to back, and a row ID.back") {
  const Loaded loaded =
      load(kHead +
           "  - {id: leaf, polygon: [[0,0,0],[3,0,0],[3,1,0],[0,1,0]], material: lamp, two_sided: true}\n  - "
           "{id: tri, polygon: [[0,0,1],[3,0,1],[3,1,1]], material: white, two_sided: true}\n");
  REQUIRE(loaded.errors.empty());
  const FaceTable& faces = loaded.scene.faces;
  const std::vector<std::string> ids = {"leaf", "leaf.back", "tri", "tri.back"};
  CHECK(loaded.scene.polygons.id == ids);
  for (uint32_t f = 0; f < faces.size(); ++f) {
    REQUIRE(faces.twin[f] != kNone);
    const uint32_t twin = faces.twin[f];
    CHECK(faces.twin[twin] == f);
    CHECK(faces.polygon[twin] != faces.polygon[f]);
    CHECK(faces.normal[twin] == -faces.normal[f]);
    std::set<std::tuple<float, float, float>> a, b;
    for (size_t k = 0; k < 4; ++k) a.insert(key(faces.corners[f][k])), b.insert(key(faces.corners[twin][k]));
    CHECK(a == b);
    const auto& c = faces.corners[f];
    CHECK(glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), faces.normal[f]) > 0);
    if (faces.corner_count[f] == 3) CHECK(c[2] == c[3]);
  }
}

TEST_CASE("every polygon keeps the direction of its first edge") {
  const Scene scene = load(kBase +
                           "  - {id: leaf, polygon: [[2,0,0],[2,0,0],[2,3,0],[1,1,0]], material: white, "
                           "two_sided: true}\n")
                          .scene;
  REQUIRE(scene.polygons.first_edge.size() == scene.polygons.size());
  CHECK(scene.polygons.first_edge[0] == Vec3(0, 0, 1));
  CHECK(scene.polygons.first_edge[1] == Vec3(1, 0, 0));
  // Corners that repeat make no edge.
  CHECK(scene.polygons.first_edge[2] == Vec3(0, 1, 0));
  CHECK(scene.polygons.first_edge[3] == Vec3(0, 1, 0));
}

TEST_CASE("face rows of a polygon are one range") {
  const Loaded loaded = load(
      kBase + "  - {id: long, quad: {size: [9,1], center: [0,5,0]}, material: white, two_sided: true}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  REQUIRE(scene.polygons.face_first.size() == scene.polygons.size() + 1);
  CHECK(scene.polygons.face_first.back() == scene.faces.size());
  for (uint32_t p = 0; p < scene.polygons.size(); ++p)
    for (uint32_t f = scene.polygons.face_first[p]; f < scene.polygons.face_first[p + 1]; ++f)
      CHECK(scene.faces.polygon[f] == p);
  CHECK(scene.polygons.line[2] == 8);
}

TEST_CASE("subdivide asks for at least n times n patches on the polygon") {
  const Loaded loaded = load(kHead +
                             "  - {quad: {size: [1,1]}, material: white, subdivide: 5}\n  - {quad: {size: "
                             "[4,1], center: [0,1,0]}, material: white, subdivide: 4}\n");
  REQUIRE(loaded.errors.empty());
  CHECK(loaded.scene.faces.level_min[0] == 3);
  REQUIRE(loaded.scene.faces.size() == 5);
  CHECK(loaded.scene.faces.level_min[1] == 1);  // four faces of 4 patches
}

TEST_CASE("lengths of settings and cameras come in engine lengths") {
  const Loaded loaded =
      load("units: mm\n" + kBase +
           "  - {quad: {size: [1000,1000]}, material: white, patch_size: 100, patch_size_min: 20}\ncamera: "
           "{eye: [0,0,2000], target: [0,0,0]}\nsolver: {patch_size: 50, patch_size_min: 5}\n");
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  CHECK(scene.metres_per_unit == 0.001);
  CHECK(scene.faces.patch_size.back() * scene.units_per_length == doctest::Approx(100));
  CHECK(scene.faces.patch_size_min.back() * scene.units_per_length == doctest::Approx(20));
  CHECK(scene.solver.patch_size * scene.units_per_length == doctest::Approx(50));
  CHECK(scene.solver.patch_size_min * scene.units_per_length == doctest::Approx(5));
  const DVec3 eye = scene.cameras[0].eye * scene.units_per_length + scene.origin;
  CHECK(glm::length(eye - DVec3(0, 0, 2000)) < 1e-9);
}

TEST_CASE("a wall a little off plane becomes triangles with normals of their own") {
  const Loaded loaded =
      load(kHead + "  - {polygon: [[0,0,0],[1,0,0],[1,0.02,1],[0,0,1]], material: white}\n");
  REQUIRE(loaded.errors.empty());
  REQUIRE(loaded.scene.faces.size() == 2);
  CHECK(loaded.scene.faces.corner_count[0] == 3);
  CHECK(loaded.scene.faces.normal[0] != loaded.scene.faces.normal[1]);
}

TEST_CASE("a mm-sized polygon far from the origin keeps its shape") {
  const Loaded loaded = load(
      kHead +
      "  - {polygon: [[1e6,0,0],[1000000.001,0,0],[1000000.001,0.001,0],[1e6,0.001,0]], material: lamp}\n");
  REQUIRE(loaded.errors.empty());
  CHECK(face_area(loaded.scene, 0) == doctest::Approx(1e-6).epsilon(1e-3));
}

TEST_CASE("outlines become faces without a file: ids, materials, twins and units") {
  Messages messages;
  messages.files.push_back({"t.yaml", ""});
  Tree tree;
  tree.file_first = {0};
  tree.nodes.resize(1);
  MaterialTable materials;
  materials.reflectance = {DRgb(0.25), DRgb(0.5)};
  materials.emission = {DRgb(0), DRgb(7)};
  materials.is_heat = materials.by_power = {0, 0};
  ObjectTable objects;
  objects.top_ids = {"a", "b"};
  objects.top = {0, 1};
  objects.node = objects.subdivide_node = {0, 0};
  objects.two_sided = {0, 1};
  objects.is_mesh = objects.is_smooth = objects.is_solid = {0, 0};
  objects.patch_size = {0, 2};
  objects.patch_size_min = {0, 1};
  objects.subdivide = {4, 1};
  OutlineTable outlines;
  const DVec3 square[] = {DVec3(0, 0, 0), DVec3(0, 0, 8), DVec3(8, 0, 8), DVec3(8, 0, 0)};
  const DVec3 triangle[] = {DVec3(0, 1, 0), DVec3(4, 1, 0), DVec3(0, 1, 4)};
  add_polygon(outlines, 0, "square", 0, 0, square);
  add_polygon(outlines, 1, "triangle", 1, 0, triangle);
  Scene scene;
  make_faces(messages, tree, materials, objects, outlines, 1000, scene);
  REQUIRE(messages.errors.empty());
  CHECK(scene.polygons.id == std::vector<std::string>{"square", "triangle", "triangle.back"});
  CHECK(scene.polygons.object == std::vector<uint32_t>{0, 1, 1});
  REQUIRE(scene.faces.size() == 3);
  CHECK(scene.units_per_length == 8);  // the root of 64 + 8, rounded down to a power of two
  CHECK(scene.faces.reflectance[0] == Rgb(0.25f));
  CHECK(scene.faces.emission[2] == Rgb(7));
  CHECK(scene.faces.level_min[0] == 2);
  CHECK(scene.faces.patch_size[1] == 0.25f);
  CHECK(scene.faces.patch_size_min[1] == 0.125f);
  CHECK(scene.faces.twin[1] == 2);
  CHECK(scene.faces.normal[0] == Vec3(0, 1, 0));
  CHECK(scene.faces.normal[1] == Vec3(0, -1, 0));
  CHECK(face_area(scene, 0) == doctest::Approx(64));
}

TEST_CASE("polygons that single precision cannot hold are told, and never all of them left out") {
  const std::string quads =
      "  - {id: a, quad: {size: [1, 1]}, material: white}\n  - {id: b, quad: {size: [1, 1], center: ";
  const Loaded apart = load(kHead + quads + "[1e9, 0, 0]}, material: white}\n");
  REQUIRE(apart.errors.size() == 1);
  CHECK(apart.errors[0].slug == "coordinate-too-large");
  const Loaded beside = load(
      kHead + quads + "[1e9, 0, 0]}, material: white}\n  - {quad: {size: [1e9, 1e9]}, material: white}\n");
  REQUIRE(beside.errors.empty());
  CHECK(beside.scene.faces.size() > 0);
  size_t lost = 0;
  for (const Diagnostic& warning : beside.warnings)
    lost += warning.slug == "scale-ratio" && warning.message.find("is left out") != std::string::npos;
  CHECK(lost == 1);  // a stays: it is at the origin
  const Loaded tiny = load(
      "patchlight: 1\nmaterials: {l: {emission: 1}}\n"
      "objects: [{polygon: [[0,0,0],[1e-165,0,0],[0,0,1e-165]], material: l}]\n");
  CHECK(!tiny.errors.empty());
}

}  // namespace

TEST_CASE("fine corners are those of the file, also of faces that single precision cannot hold") {
  std::vector<Diagnostic> warnings;
  LoadOptions options;
  options.fine_corners = true;
  const Scene scene =
      load_scene_text(kHead +
                          "  - {id: far, quad: {size: [1e9, 1e9]}, material: white}\n"
                          "  - {id: near, polygon: [[1e9, 0, 0], [1e9, 0, 1], [1000000001, 0, "
                          "1]], material: white, two_sided: true}\n",
                      "t.yaml", warnings, options);
  REQUIRE(scene.faces.size() == 3);
  REQUIRE(scene.fine_corners.size() == 3);
  // Units are a power of two, so that every digit is kept.
  CHECK(scene.fine_corners[1][0] * scene.units_per_length == DVec3(1e9, 0, 0));
  CHECK(scene.fine_corners[1][2] * scene.units_per_length == DVec3(1000000001, 0, 1));
  CHECK(scene.fine_corners[2][1] * scene.units_per_length == DVec3(1000000001, 0, 1));
  CHECK(load_scene_text(kHead + "  - {id: a, quad: {size: [1, 1]}, material: white}\n", "t.yaml", warnings)
            .fine_corners.empty());
}

}  // namespace patchlight::test
