// Disks, cylinders, spheres, prisms and grids: closed where they should be, facing the right way, areas by
// closed form.
#include "tests/dsl/support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace patchlight::test {
namespace {

constexpr double kPiDouble = std::numbers::pi;

Loaded load_shape(const std::string& shape) {
  Loaded loaded = load(kHead + "  - {id: s, " + shape + ", material: lamp}\n");
  for (const Diagnostic& error : loaded.errors) MESSAGE(error.message);
  REQUIRE(loaded.errors.empty());
  return loaded;
}

double total_area(const Scene& scene) {
  double sum = 0;
  for (size_t f = 0; f < scene.faces.size(); ++f) sum += face_area(scene, f);
  return sum;
}

// A third of the sum of (corner . normal) area: the volume inside, negative when the faces look inward.
double volume(const Scene& scene) {
  double sum = 0;
  for (size_t f = 0; f < scene.faces.size(); ++f)
    sum += glm::dot(corner_in_file(scene, f, 0), DVec3(scene.faces.normal[f])) * face_area(scene, f) / 3;
  return sum;
}

TEST_CASE("a disk is one polygon with its corners on the circle") {
  const Loaded loaded = load_shape("disk: {radius: 2, normal: [0,0,3], center: [1,2,3], sides: 24}");
  CHECK(loaded.scene.polygons.size() == 1);
  CHECK(total_area(loaded.scene) == doctest::Approx(0.5 * 24 * 4 * std::sin(kPiDouble / 12)).epsilon(1e-5));
  for (const Vec3& normal : loaded.scene.faces.normal) CHECK(normal.z == doctest::Approx(1));
}

TEST_CASE("a cylinder is closed and looks outward, or inward") {
  const double base = 0.5 * 12 * std::sin(kPiDouble / 6);
  const Loaded outward = load_shape("cylinder: {radius: 1, height: 3, sides: 12, at: [5,1,0]}");
  CHECK(outward.scene.polygons.size() == 14);
  CHECK(outward.scene.polygons.id.front() == "s.0");
  CHECK(outward.scene.polygons.id.back() == "s.top");
  CHECK(volume(outward.scene) == doctest::Approx(3 * base).epsilon(1e-5));
  const Loaded inward = load_shape("cylinder: {radius: 1, height: 3, sides: 12, inward: true}");
  CHECK(volume(inward.scene) == doctest::Approx(-3 * base).epsilon(1e-5));
  CHECK(load_shape("cylinder: {radius: 1, height: 3, sides: 12, caps: false}").scene.polygons.size() == 12);
}

TEST_CASE("a sphere is closed and looks outward") {
  const Loaded loaded = load_shape("sphere: {radius: 2, center: [1,1,1]}");
  CHECK(loaded.scene.polygons.size() == 24 * 12);
  CHECK(loaded.warnings.size() == count_slug(loaded.warnings, "unused-material"));
  const double exact = 4.0 / 3 * kPiDouble * 8;
  CHECK(volume(loaded.scene) > 0.95 * exact);
  CHECK(volume(loaded.scene) < exact);
}

TEST_CASE("a prism grows along its base's normal") {
  const Loaded loaded =
      load_shape("prism: {base: [[0,0,0],[0,0,2],[1,0,2],[1,0,1],[3,0,1],[3,0,0]], height: 2}");
  CHECK(loaded.scene.polygons.size() == 8);
  CHECK(volume(loaded.scene) == doctest::Approx(8).epsilon(1e-5));
  const Loaded room =
      load_shape("prism: {base: [[0,0,0],[0,0,2],[1,0,2],[1,0,1],[3,0,1],[3,0,0]], height: 2, inward: true}");
  CHECK(volume(room.scene) == doctest::Approx(-8).epsilon(1e-5));
}

TEST_CASE("a grid is as many polygons as cells, numbered row by row") {
  const Loaded loaded = load_shape("grid: {size: [3,2], cells: [3,2]}");
  CHECK(loaded.scene.polygons.size() == 6);
  CHECK(loaded.scene.polygons.id[5] == "s.5");
  for (size_t f = 0; f < 6; ++f) CHECK(face_area(loaded.scene, f) == doctest::Approx(1));
  // Neighbours share the bits of their corners.
  CHECK(loaded.scene.faces.corners[0][1] == loaded.scene.faces.corners[1][0]);
  CHECK(loaded.scene.faces.corners[0][2] == loaded.scene.faces.corners[4][0]);
}

}  // namespace
}  // namespace patchlight::test
