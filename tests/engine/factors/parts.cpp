// Faces joined to parts.
#include "engine/factors/parts.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

void add_cell(FaceTable& faces, float x, float y, uint32_t polygon) {
  add_face(faces, std::array{Vec3(x, y, 0), Vec3(x + 1, y, 0), Vec3(x + 1, y + 1, 0), Vec3(x, y + 1, 0)},
           polygon, {});
}

// Length of the outline, and area within it.
std::array<double, 2> measure(std::span<const Segment> outline) {
  double length_sum = 0, area = 0;
  for (const auto& [a, b] : outline) length_sum += length(b - a), area += cross(a, b).z / 2;
  return {length_sum, area};
}

}  // namespace

TEST_CASE("a quad cut into cells is one convex part with the quad's outline") {
  FaceTable faces;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 3; ++y) add_cell(faces, static_cast<float>(x), static_cast<float>(y), 0);
  const PartTable parts = make_parts(faces, 1);
  REQUIRE(parts.size() == 1);
  CHECK(part_outline(parts, 0).size() == 4);
  CHECK(measure(part_outline(parts, 0)) == std::array<double, 2>{14, 12});
  CHECK(parts.piece_first[1] == 1);
  CHECK(piece_corners(parts, 0).size() == 4);
  CHECK(parts.convex[0] == 1);
  CHECK(parts.area[0] == 12);
  CHECK(parts.radius[0] == doctest::Approx(2.5));
}

TEST_CASE("a frame has two rings in its outline, few pieces, and a hull without its hole") {
  FaceTable faces;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      if (x != 1 || y != 1) add_cell(faces, static_cast<float>(x), static_cast<float>(y), 0);
  const PartTable parts = make_parts(faces, 1);
  REQUIRE(parts.size() == 1);
  CHECK(part_outline(parts, 0).size() == 8);
  CHECK(measure(part_outline(parts, 0)) == std::array<double, 2>{16, 8});
  CHECK(parts.piece_first[1] == 4);
  double area = 0;
  for (uint32_t piece = 0; piece < 4; ++piece) {
    const auto corners = piece_corners(parts, piece);
    for (size_t k = 0; k < corners.size(); ++k)
      area += cross(corners[k], corners[(k + 1) % corners.size()]).z / 2;
  }
  CHECK(area == doctest::Approx(8));
  CHECK(parts.convex[0] == 0);
  CHECK(part_hull(parts, 0).size() == 4);
}

TEST_CASE(
    "faces of a bent polygon are parts of their own, those of a polygon off plane by rounding are not") {
  FaceTable bent, flat;
  add_face(bent, std::array{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, 0, {});
  add_face(bent, std::array{Vec3(1, 0, 0), Vec3(1, 1, 0.02f), Vec3(0, 1, 0)}, 0, {});
  add_face(flat, std::array{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, 0, {});
  add_face(flat, std::array{Vec3(1, 0, 0), Vec3(1, 1, 1e-5f), Vec3(0, 1, 0)}, 0, {});
  const PartTable two = make_parts(bent, 1);
  CHECK(two.size() == 2);
  CHECK(two.polygon_first == std::vector<uint32_t>{0, 2});
  CHECK(two.part_of_face == std::vector<uint32_t>{0, 1});
  CHECK(make_parts(flat, 1).size() == 1);
}

TEST_CASE("polygons without faces have no parts") {
  FaceTable faces;
  add_cell(faces, 0, 0, 1);
  const PartTable parts = make_parts(faces, 3);
  CHECK(parts.size() == 1);
  CHECK(parts.polygon_first == std::vector<uint32_t>{0, 0, 1, 1});
}

TEST_CASE("a disc of many corners has a rectangle around it for a hull") {
  FaceTable faces;
  const auto ring = make_ring(Vec3(0), 1, 24, 1);
  add_fan(faces, Vec3(0), ring, {});
  const PartTable parts = make_parts(faces, 1);
  CHECK(part_outline(parts, 0).size() == 24);
  CHECK(parts.piece_first[1] == 1);
  const auto hull = part_hull(parts, 0);
  REQUIRE(hull.size() == 4);
  for (size_t k = 0; k < 4; ++k) {
    const DVec3 edge = hull[(k + 1) % 4] - hull[k];
    for (const Vec3& p : ring) CHECK(dot(cross(parts.front[0].normal, edge), DVec3(p) - hull[k]) >= -1e-6);
  }
}

TEST_CASE("fine corners stand where floats have lost them, and off the plane by their own measure") {
  FaceTable faces;
  add_face(faces, std::array{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 0, {});
  FineCorners fine;
  fine.corners = {{DVec3(7, 0, 1e-12), DVec3(8, 0, 1e-12), DVec3(8, 1, 1e-12), DVec3(7, 1, 1e-12)}};
  fine.shift = DVec3(7, 0, 0);
  const PartTable parts = make_parts(faces, 1, fine);
  REQUIRE(parts.size() == 1);
  CHECK(parts.front[0].height == 1e-12);
  CHECK(parts.centre[0].x == 7.5);
  CHECK(parts.off_plane[0] <= 1e-15);
  CHECK(parts.touch[0] < 1e-12);
  CHECK(make_parts(faces, 1).touch[0] > 1e-7);
}

TEST_CASE("what lies around a polygon that is off its plane lies in the plane") {
  // A star of six corners, which turn inwards every second time and lie off the plane by a millionth in turn.
  FaceTable faces;
  std::vector<Vec3> ring;
  for (int k = 0; k < 6; ++k) {
    const auto angle = static_cast<float>(k) * kPi / 3;
    const float radius = k % 2 == 0 ? 1.0f : 0.3f;
    ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle), k < 3 ? 1e-6f : -1e-6f);
  }
  add_fan(faces, Vec3(0), ring, {});
  const PartTable parts = make_parts(faces, 1);
  REQUIRE(parts.size() == 1);
  CHECK(parts.convex[0] == 0);
  for (const DVec3& p : part_hull(parts, 0)) CHECK(std::abs(height_above(parts.front[0], p)) <= 1e-15);
}
