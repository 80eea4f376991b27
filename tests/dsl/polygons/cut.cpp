// Polygons become faces that cover them, share whole edges, and are well shaped.
#include "dsl/polygons/cut.h"

#include "dsl/polygons/flatten.h"
#include "tests/dsl/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace patchlight::test {
namespace {

using Ring = std::vector<DVec3>;

struct Cut {
  FlatPolygon flat;
  CutFaces faces;
  bool good = false;
};

Cut cut_rings_of(const std::vector<Ring>& rings, bool emits = false) {
  Messages messages;
  messages.files.push_back({"t.yaml", ""});
  Tree tree;
  tree.file_first = {0};
  tree.nodes.resize(1);
  OutlineTable outlines;
  add_polygon(outlines, 0, "p", 0, 0, rings[0]);
  for (size_t k = 1; k < rings.size(); ++k) add_hole(outlines, 0, rings[k]);
  Cut cut;
  cut.good =
      flatten_polygon(messages, tree, outlines, 0, cut.flat) && cut_polygon(cut.flat, emits, cut.faces);
  return cut;
}

double area_of(const CutFaces& cut, const FaceCorners& face) {
  const auto p = [&](size_t k) { return cut.points[face[k]]; };
  return glm::length(glm::cross(p(1) - p(0), p(2) - p(0)) + glm::cross(p(2) - p(0), p(3) - p(0))) / 2;
}

double sum_of_areas(const CutFaces& cut) {
  double sum = 0;
  for (const FaceCorners& face : cut.faces) sum += area_of(cut, face);
  return sum;
}

// Every edge belongs to one face or to two that run along it in opposite directions, and those with one face
// have the polygon's own length: no T-junctions, nothing covered twice.
void check_conforming(const Cut& cut, double perimeter) {
  std::map<std::pair<uint32_t, uint32_t>, int> count;
  for (const FaceCorners& face : cut.faces.faces) {
    const size_t corners = is_triangle(face) ? 3 : 4;
    for (size_t k = 0; k < corners; ++k) ++count[{face[k], face[(k + 1) % corners]}];
  }
  double border = 0;
  for (const auto& [edge, times] : count) {
    CHECK(times == 1);
    if (!count.contains({edge.second, edge.first}))
      border += glm::length(cut.faces.points[edge.second] - cut.faces.points[edge.first]);
  }
  CHECK(border == doctest::Approx(perimeter).epsilon(1e-9));
}

Ring regular(size_t count, double radius, DVec3 centre = DVec3(0)) {
  Ring ring;
  for (size_t k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
    ring.push_back(centre + DVec3(std::cos(angle), std::sin(angle), 0) * radius);
  }
  return ring;
}

double smallest_angle(const CutFaces& cut) {
  double least = 180;
  for (const FaceCorners& face : cut.faces) {
    const size_t n = is_triangle(face) ? 3 : 4;
    for (size_t k = 0; k < n; ++k) {
      const DVec3 a = cut.points[face[(k + 1) % n]] - cut.points[face[k]];
      const DVec3 b = cut.points[face[(k + n - 1) % n]] - cut.points[face[k]];
      least = std::min(least,
                       std::acos(glm::dot(a, b) / glm::length(a) / glm::length(b)) * 180 / std::numbers::pi);
    }
  }
  return least;
}

TEST_CASE("a square stays one face, and a long quad becomes near squares") {
  CHECK(cut_rings_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}).faces.faces.size() == 1);
  const Cut wall = cut_rings_of({{{0, 0, 0}, {1, 0, 0}, {1, 7, 0}, {0, 7, 0}}});
  CHECK(wall.faces.faces.size() == 7);
  CHECK(sum_of_areas(wall.faces) == doctest::Approx(7));
  check_conforming(wall, 16);
}

TEST_CASE("a lamp is cut only when it is more than four times longer than wide") {
  CHECK(cut_rings_of({{{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}}}, true).faces.faces.size() == 1);
  CHECK(cut_rings_of({{{0, 0, 0}, {10, 0, 0}, {10, 1, 0}, {0, 1, 0}}}, true).faces.faces.size() == 3);
}

TEST_CASE("a quad far from a parallelogram becomes two triangles") {
  const Cut cut = cut_rings_of({{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  CHECK(cut.faces.faces.size() == 2);
  CHECK(sum_of_areas(cut.faces) == doctest::Approx(2.5));
}

TEST_CASE("an arrow head is cut at the diagonal that lies inside") {
  const Cut cut = cut_rings_of({{{0, 0, 0}, {2, -2, 0}, {0, 4, 0}, {-2, -2, 0}}});
  CHECK(cut.faces.faces.size() == 2);
  CHECK(sum_of_areas(cut.faces) == doctest::Approx(8));
  check_conforming(cut, 2 * std::sqrt(8.0) + 2 * std::sqrt(40.0));
}

TEST_CASE("a wall with three windows becomes a conforming grid of rectangles") {
  const auto window = [](double z) {
    return Ring{{0, 0.8, z}, {0, 0.8, z + 1.2}, {0, 2.4, z + 1.2}, {0, 2.4, z}};
  };
  const Cut cut =
      cut_rings_of({{{0, 0, 0}, {0, 3, 0}, {0, 3, 7}, {0, 0, 7}}, window(0.8), window(2.9), window(5.0)});
  REQUIRE(cut.good);
  CHECK(sum_of_areas(cut.faces) == doctest::Approx(21 - 3 * 1.2 * 1.6));
  check_conforming(cut, 20 + 3 * 5.6);
  CHECK(cut.faces.faces.size() < 100);
  CHECK(smallest_angle(cut.faces) == doctest::Approx(90));
  for (const FaceCorners& face : cut.faces.faces) {
    const double a = glm::length(cut.faces.points[face[1]] - cut.faces.points[face[0]]);
    const double b = glm::length(cut.faces.points[face[2]] - cut.faces.points[face[1]]);
    CHECK(std::max(a, b) / std::min(a, b) < 2.5);
  }
}

TEST_CASE("an L is cut along its own lines, turned or not") {
  Ring ring = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  CHECK(cut_rings_of({ring}).faces.faces.size() == 3);
  for (DVec3& p : ring) p = DVec3(p.x * 0.8 - p.y * 0.6, p.x * 0.6 + p.y * 0.8, 5);
  const Cut turned = cut_rings_of({ring});
  CHECK(turned.faces.faces.size() == 3);
  CHECK(sum_of_areas(turned.faces) == doctest::Approx(3));
}

TEST_CASE("a star with a hole is covered by faces that share whole edges") {
  Ring star;
  for (size_t k = 0; k < 20; ++k) star.push_back(regular(20, k % 2 ? 1.0 : 2.5)[k]);
  const Cut cut = cut_rings_of({star, regular(5, 0.4), regular(4, 0.15, DVec3(0.6, 0, 0))});
  REQUIRE(cut.good);
  CHECK(sum_of_areas(cut.faces) == doctest::Approx(cut.flat.area * cut.flat.size * cut.flat.size));
  const double outline = 20 * glm::length(star[1] - star[0]);
  check_conforming(
      cut, outline + 10 * 0.4 * std::sin(std::numbers::pi / 5) + 8 * 0.15 * std::sin(std::numbers::pi / 4));
}

TEST_CASE("a polygon of many corners has no slivers") {
  for (const size_t count : {7, 8, 9, 12, 13, 24, 25, 64, 100, 1000}) {
    CAPTURE(count);
    const Cut cut = cut_rings_of({regular(count, 1)});
    REQUIRE(cut.good);
    const double area =
        0.5 * static_cast<double>(count) * std::sin(2 * std::numbers::pi / static_cast<double>(count));
    CHECK(sum_of_areas(cut.faces) == doctest::Approx(area).epsilon(1e-9));
    check_conforming(
        cut, 2 * static_cast<double>(count) * std::sin(std::numbers::pi / static_cast<double>(count)));
    CHECK(smallest_angle(cut.faces) > 9);
  }
}

TEST_CASE("a comb of ten thousand corners is cut") {
  Ring comb = {{0, -1, 0}, {3300, -1, 0}};
  for (int k = 0; k < 3300; ++k) {
    const double x = k;
    comb.insert(comb.begin(), {x + 0.5, 0.001 * (k % 7), 0});
    comb.insert(comb.begin(), {x, 50 + 0.1 * (k % 13), 0});
    comb.insert(comb.begin(), {x + 0.25, 60, 0});
  }
  const Cut cut = cut_rings_of({comb});
  REQUIRE(cut.good);
  CHECK(sum_of_areas(cut.faces) ==
        doctest::Approx(cut.flat.area * cut.flat.size * cut.flat.size).epsilon(1e-9));
}

TEST_CASE("holes by the dozen are bridged") {
  std::vector<Ring> rings = {{{0, 0, 0}, {20, 1, 0}, {20, 20, 0}, {0, 20, 0}}};
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) rings.push_back(regular(6, 1, DVec3(3.5 + 3 * x, 3.5 + 3 * y, 0)));
  const Cut cut = cut_rings_of(rings);
  REQUIRE(cut.good);
  CHECK(sum_of_areas(cut.faces) == doctest::Approx(390 - 25 * 3 * std::sin(std::numbers::pi / 3)));
}

TEST_CASE("holes in line with each other and with a corner are bridged past the corners between") {
  const Cut cut = cut_rings_of({{{6.75, 5, 0},
                                 {3.25, 3.5, 0},
                                 {5, 7.5, 0},
                                 {-1.75, 7.25, 0},
                                 {-6.75, 3.75, 0},
                                 {-8.5, -5, 0},
                                 {0.5, -7.5, 0},
                                 {2, -9.5, 0}},
                                {{1.5, 2, 0}, {2, 1.5, 0}, {2, 1, 0}},
                                {{-2.25, 0.5, 0},
                                 {-2.75, 0.5, 0},
                                 {-2.5, 0.25, 0},
                                 {-3.5, 0.25, 0},
                                 {-3.75, 0.5, 0},
                                 {-3.5, 1.25, 0},
                                 {-2, 0.75, 0}},
                                {{-0.25, 2.5, 0},
                                 {-0.5, 2, 0},
                                 {-0.75, 2.5, 0},
                                 {-1, 2.25, 0},
                                 {-1.5, 2.5, 0},
                                 {-1, 3.5, 0},
                                 {-1, 3.25, 0}}});
  REQUIRE(cut.good);
  CHECK(sum_of_areas(cut.faces) == doctest::Approx(159.1875));
}

TEST_CASE("corners on a straight edge stay corners of faces") {
  const Cut cut = cut_rings_of({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0.5, 0}, {1, 3, 0}}});
  REQUIRE(cut.good);
  CHECK(sum_of_areas(cut.faces) == doctest::Approx(cut.flat.area * cut.flat.size * cut.flat.size));
  std::vector<bool> used(5, false);
  for (const FaceCorners& face : cut.faces.faces)
    for (const uint32_t k : face)
      if (k < 5) used[k] = true;
  CHECK(std::all_of(used.begin(), used.end(), [](bool b) { return b; }));
}

}  // namespace
}  // namespace patchlight::test
