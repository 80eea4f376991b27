#include "engine/mesh/quadtree.h"

#include "engine/base/sampling.h"
#include "engine/mesh/face_links.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace patchlight;

namespace {

struct Trees {
  FaceTable faces;
  FaceFrameTable frames;
  FaceLinkTable links;
  PatchTable leaves;
};

Trees make_mesh(FaceTable faces, uint32_t level) {
  Trees mesh{std::move(faces), {}, {}, {}};
  mesh.frames = make_face_frames(mesh.faces);
  mesh.links = make_face_links(mesh.faces);
  mesh.leaves = make_leaves(mesh.faces, mesh.frames, [&](uint32_t) { return level; });
  return mesh;
}

FaceTable make_hexagon() {
  FaceTable faces;
  add_fan(faces, Vec3(0.1f, 0, 0.05f), make_ring(Vec3(0), 0.5f, 6, 1), make_surface(0, 0.5f));
  return faces;
}

// How far a point is from a segment.
float distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const float t = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0f, 1.0f);
  return distance(p, a + t * (b - a));
}

std::array<Vec3, 2> edge_ends(const Trees& mesh, uint32_t row, uint32_t edge) {
  const PatchTable& leaves = mesh.leaves;
  const auto c = cell_corners(mesh.frames, leaves.face[row], leaves.cell[row], leaves.level[row]);
  return {c[edge], c[(edge + 1) % edge_count(mesh.frames, leaves.face[row])]};
}

void check_sorted(const Trees& mesh) {
  const PatchTable& leaves = mesh.leaves;
  REQUIRE(leaves.face_first.size() == mesh.faces.size() + 1);
  REQUIRE(leaves.face_first.back() == leaves.size());
  for (uint32_t face = 0; face < mesh.faces.size(); ++face) {
    uint64_t expected = 0;  // leaves of a face follow each other without gaps
    for (uint32_t row = leaves.face_first[face]; row < leaves.face_first[face + 1]; ++row) {
      REQUIRE(leaves.face[row] == face);
      REQUIRE(leaves.cell[row] == expected);
      expected += cell_span(leaves.level[row]);
    }
    REQUIRE(expected == uint64_t{1} << 32);
  }
}

// Neighbours share a part of the edge, know each other, and differ by one level at most; what has none is the
// border.
void check_neighbours(const Trees& mesh, double perimeter) {
  const PatchTable& leaves = mesh.leaves;
  double border = 0;
  for (uint32_t row = 0; row < leaves.size(); ++row)
    for (uint32_t edge = 0; edge < edge_count(mesh.frames, leaves.face[row]); ++edge) {
      const auto [from, to] = edge_ends(mesh, row, edge);
      const auto found = find_neighbours(leaves, mesh.frames, mesh.links, row, edge);
      const uint32_t coarse = find_coarse_neighbour(leaves, mesh.frames, mesh.links, row, edge);
      if (found[0] == kNone) {
        REQUIRE(found[1] == kNone);
        REQUIRE(coarse == kNone);
        border += distance(from, to);
        continue;
      }
      REQUIRE((coarse == found[0]) == (leaves.level[found[0]] <= leaves.level[row]));
      REQUIRE((found[1] == kNone) == (leaves.level[found[0]] <= leaves.level[row]));
      for (const uint32_t other : found) {
        if (other == kNone) continue;
        REQUIRE(other != row);
        REQUIRE(std::abs(leaves.level[other] - leaves.level[row]) <= 1);
        // The middle of the shorter of the two edges lies on both; and the way back leads here.
        bool back = false;
        for (uint32_t k = 0; k < edge_count(mesh.frames, leaves.face[other]); ++k) {
          const auto theirs = find_neighbours(leaves, mesh.frames, mesh.links, other, k);
          if (theirs[0] != row && theirs[1] != row) continue;
          const auto [a, b] = edge_ends(mesh, other, k);
          const bool shorter = distance(a, b) < distance(from, to);
          const Vec3 middle = shorter ? 0.5f * (a + b) : 0.5f * (from + to);
          back |= distance_to_segment(middle, a, b) < 1e-5f && distance_to_segment(middle, from, to) < 1e-5f;
        }
        REQUIRE(back);
      }
    }
  CHECK(border == doctest::Approx(perimeter).epsilon(1e-5));
}

double find_perimeter(const std::vector<Vec3>& rim) {
  double sum = 0;
  for (size_t k = 0; k < rim.size(); ++k) sum += distance(rim[k], rim[(k + 1) % rim.size()]);
  return sum;
}

const std::vector<Vec3> kMixedRim = {{0, 0, 0},       {1, 0, 0}, {1.8f, 0.4f, 0},  {1, 1, 0},
                                     {0.4f, 1.7f, 0}, {0, 1, 0}, {-0.6f, 0.8f, 0}, {-0.8f, 0.1f, 0}};

}  // namespace

TEST_CASE("leaves start with the face's emission, sorted, as fine as asked") {
  FaceTable faces = make_mixed_polygon({Rgb(1, 2, 3), Rgb(0.5f)});
  const FaceFrameTable frames = make_face_frames(faces);
  const PatchTable leaves = make_leaves(faces, frames, [](uint32_t face) { return face; });
  CHECK(leaves.size() == 1 + 4 + 16 + 64);
  for (size_t row = 0; row < leaves.size(); ++row) {
    CHECK(leaves.level[row] == leaves.face[row]);
    CHECK(leaves.exposed[row] == 1);
    CHECK(leaves.radiosity[row] == Rgb(1, 2, 3));
    CHECK(leaves.unshot[row] == Rgb(1, 2, 3));
  }
}

TEST_CASE("random splits keep the leaves sorted and without gaps, and their neighbours in order") {
  for (const uint64_t seed : {1u, 2u, 3u}) {
    Trees mesh = make_mesh(make_mixed_polygon({}), 1);
    split_at_random(mesh.leaves, mesh.frames, mesh.links, 5, seed);
    CHECK(mesh.leaves.size() > 100);
    check_sorted(mesh);
    check_neighbours(mesh, find_perimeter(kMixedRim));
    Trees fan = make_mesh(make_hexagon(), 0);
    split_at_random(fan.leaves, fan.frames, fan.links, 6, seed);
    check_sorted(fan);
    check_neighbours(fan, find_perimeter(make_ring(Vec3(0), 0.5f, 6, 1)));
  }
}

TEST_CASE("balancing evens out large steps between the faces of a polygon, and no others") {
  FaceTable faces = make_mixed_polygon({});
  add_quad(faces, {0, 0, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0},
           {});  // shares an edge, but is another polygon
  Trees mesh = make_mesh(std::move(faces), 0);
  mesh.leaves = make_leaves(mesh.faces, mesh.frames, [](uint32_t face) { return face == 0 ? 6u : 0u; });
  balance_leaves(mesh.leaves, mesh.frames, mesh.links);
  check_sorted(mesh);
  check_neighbours(mesh, find_perimeter(kMixedRim) + 4);
  CHECK(mesh.leaves.face_first[5] - mesh.leaves.face_first[4] == 1);
}

TEST_CASE("splitting inherits W/m2, so that area and power stay") {
  Trees mesh = make_mesh(make_mixed_polygon({}), 2);
  for (uint32_t row = 0; row < mesh.leaves.size(); ++row) {
    mesh.leaves.radiosity[row] = Rgb(static_cast<float>(row), 1, 0.5f);
    mesh.leaves.unshot[row] = Rgb(2, static_cast<float>(row), 0);
    mesh.leaves.exposed[row] = make_jitter(5, row).x;
  }
  const PatchTable before = mesh.leaves;
  std::vector<uint8_t> marks(before.size());
  for (uint32_t row = 0; row < before.size(); ++row) marks[row] = row % 3 == 0;
  std::vector<uint32_t> parent;
  const PatchTable after = split_leaves(before, mesh.frames, marks, parent);
  REQUIRE(parent.size() == after.size());
  CHECK(after.size() == before.size() + 3 * static_cast<size_t>(std::count(marks.begin(), marks.end(), 1)));
  std::vector<double> area(before.size(), 0);
  for (size_t row = 0; row < after.size(); ++row) {
    const uint32_t from = parent[row];
    area[from] += after.area[row];
    CHECK(after.level[row] == before.level[from] + (marks[from] ? 1 : 0));
    CHECK(cell_ancestor(after.cell[row], before.level[from]) == before.cell[from]);
    CHECK(after.radiosity[row] == before.radiosity[from]);
    CHECK(after.unshot[row] == before.unshot[from]);
    CHECK(after.exposed[row] == before.exposed[from]);
  }
  // Four areas from corners in float.
  for (size_t row = 0; row < before.size(); ++row)
    CHECK(area[row] == doctest::Approx(before.area[row]).epsilon(1e-5));
}

TEST_CASE("splitting nothing gives the same leaves") {
  const Trees mesh = make_mesh(make_hexagon(), 2);
  std::vector<uint32_t> parent;
  const PatchTable after =
      split_leaves(mesh.leaves, mesh.frames, std::vector<uint8_t>(mesh.leaves.size(), 0), parent);
  CHECK(after.cell == mesh.leaves.cell);
  CHECK(after.face_first == mesh.leaves.face_first);
  for (uint32_t row = 0; row < parent.size(); ++row) CHECK(parent[row] == row);
}

TEST_CASE("the leaf of a point is found by its cell") {
  Trees mesh = make_mesh(make_mixed_polygon({}), 1);
  split_at_random(mesh.leaves, mesh.frames, mesh.links, 5, 9);
  for (uint32_t trial = 0; trial < 4000; ++trial) {
    const uint32_t face = trial % 4;
    const Vec2 uv = cell_sample(mesh.frames.triangle[face], {Vec2(0), 1}, make_jitter(3, trial));
    const uint32_t cell = find_cell(mesh.frames.triangle[face], uv);
    const uint32_t row = find_leaf(mesh.leaves, face, cell);
    REQUIRE(mesh.leaves.face[row] == face);
    REQUIRE(cell_ancestor(cell, mesh.leaves.level[row]) == mesh.leaves.cell[row]);
  }
  CHECK(find_leaf(mesh.leaves, 3, 0xffffffffu) == mesh.leaves.size() - 1);
}

TEST_CASE("face links go both ways, stay within a polygon, and take -0 for 0") {
  FaceTable faces = make_mixed_polygon({});
  faces.corners[0][0].z = -0.0f;
  add_quad(faces, {0, 0, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}, {});
  const FaceLinkTable links = make_face_links(faces);
  uint32_t linked = 0;
  for (uint32_t face = 0; face < faces.size(); ++face)
    for (uint32_t edge = 0; edge < faces.corner_count[face]; ++edge) {
      const auto [other, back] = links.edge[face][edge];
      if (other == kNone) continue;
      ++linked;
      CHECK(faces.polygon[other] == faces.polygon[face]);
      CHECK(links.edge[other][back].face == face);
      CHECK(links.edge[other][back].edge == edge);
    }
  CHECK(linked == 6);
  // The corner at the origin is one for both quads of the polygon, and another for the second polygon.
  CHECK(links.corner[0][0] == links.corner[3][3]);
  CHECK(links.corner[4][0] == 4 * 4 + 0);
}

TEST_CASE("every coarse leaf owns the range of the fine leaves that it is the union of") {
  Trees mesh = make_mesh(make_mixed_polygon({}), 1);
  const PatchTable coarse = mesh.leaves;
  split_at_random(mesh.leaves, mesh.frames, mesh.links, 4, 11);
  const auto first = find_union_ranges(coarse, mesh.leaves);
  REQUIRE(first.size() == coarse.size() + 1);
  CHECK(first.front() == 0);
  CHECK(first.back() == mesh.leaves.size());
  for (size_t k = 0; k < coarse.size(); ++k) {
    CHECK(first[k] < first[k + 1]);
    for (uint32_t row = first[k]; row < first[k + 1]; ++row) {
      CHECK(mesh.leaves.face[row] == coarse.face[k]);
      CHECK(cell_ancestor(mesh.leaves.cell[row], coarse.level[k]) == coarse.cell[k]);
    }
  }
}

TEST_CASE("marks for balance add only what the marked leaves need") {
  Trees mesh = make_mesh(make_mixed_polygon({}), 3);
  std::vector<uint8_t> marks(mesh.leaves.size(), 0);
  marks[5] = 1;
  mark_for_balance(marks, mesh.leaves, mesh.frames, mesh.links);
  // All leaves are of one level: a split leaf stands one level above its neighbours.
  CHECK(std::count(marks.begin(), marks.end(), 1) == 1);
}

TEST_CASE("a leaf at the deepest level has its place and its neighbours") {
  FaceTable faces = make_mixed_polygon({});
  Trees mesh = make_mesh(std::move(faces), 0);
  // Down along one corner of the first quad.
  for (uint32_t level = 0; level < kLevelMax - 1; ++level) {
    std::vector<uint8_t> marks(mesh.leaves.size(), 0);
    marks[find_leaf(mesh.leaves, 0, find_cell(false, {1, 0.5f}))] = 1;
    mark_for_balance(marks, mesh.leaves, mesh.frames, mesh.links);
    std::vector<uint32_t> parent;
    mesh.leaves = split_leaves(mesh.leaves, mesh.frames, marks, parent);
  }
  CHECK(*std::max_element(mesh.leaves.level.begin(), mesh.leaves.level.end()) == kLevelMax - 1);
  check_sorted(mesh);
  check_neighbours(mesh, find_perimeter(kMixedRim));
}

namespace {

// A fan of `count` quads about the y axis, one polygon each, `angle` degrees from one to the next, all of one
// surface.
FaceTable make_bent_strip(uint32_t count, float angle) {
  FaceTable faces;
  Vec3 at(0, 0, 0);
  for (uint32_t k = 0; k < count; ++k) {
    const float turned = angle * static_cast<float>(k) * 3.14159265f / 180;
    const Vec3 next = at + Vec3(std::cos(turned), 0, std::sin(turned));
    add_quad(faces, at, next, next + Vec3(0, 1, 0), at + Vec3(0, 1, 0), {Rgb(0), Rgb(0.5f)});
    faces.surface.back() = 7;
    at = next;
  }
  return faces;
}

}  // namespace

TEST_CASE("smooth edges: polygons of one surface are joined below the crease angle, and only they") {
  const auto joined = [](const FaceTable& faces) {
    return make_smooth_links(make_face_links(faces), faces).edge[0][1].face;
  };
  CHECK(joined(make_bent_strip(2, 29)) == 1);
  CHECK(joined(make_bent_strip(2, 31)) == kNone);
  FaceTable other_surface = make_bent_strip(2, 10);
  other_surface.surface[1] = 8;
  CHECK(joined(other_surface) == kNone);
  FaceTable no_surface = make_bent_strip(2, 10);
  no_surface.surface.assign(2, kNone);
  CHECK(joined(no_surface) == kNone);
  FaceTable other_material = make_bent_strip(2, 10);
  other_material.reflectance[1] = Rgb(0.4f);
  CHECK(joined(other_material) == kNone);
}

TEST_CASE("smooth edges: corners are the same all along joined edges, and the polygons' own links stay") {
  const FaceTable faces = make_bent_strip(4, 20);
  const FaceLinkTable links = make_face_links(faces), joints = make_smooth_links(links, faces);
  for (uint32_t f = 0; f < 3; ++f) {
    CHECK(links.edge[f][1].face == kNone);
    CHECK(joints.edge[f][1].face == f + 1);
    CHECK(joints.edge[f][1].edge == 3);
    CHECK(joints.edge[f + 1][3].face == f);
    CHECK(joints.corner[f][1] == joints.corner[f + 1][0]);
    CHECK(joints.corner[f][2] == joints.corner[f + 1][3]);
    CHECK(joints.corner[f][0] != joints.corner[f][1]);
  }
}

TEST_CASE("smooth edges: of three polygons on an edge the two that go on most straightly are joined") {
  FaceTable faces = make_bent_strip(2, 20);
  // A third one starts at the edge between them, less bent.
  const Vec3 corner(1, 0, 0), next = corner + Vec3(std::cos(0.1f), 0, std::sin(0.1f));
  add_quad(faces, corner, next, next + Vec3(0, 1, 0), corner + Vec3(0, 1, 0), {Rgb(0), Rgb(0.5f)});
  faces.surface.back() = 7;
  const FaceLinkTable joints = make_smooth_links(make_face_links(faces), faces);
  CHECK(joints.edge[0][1].face == 2);
  CHECK(joints.edge[1][3].face == kNone);
}

TEST_CASE("a budget is never passed, balance included, and what weighs most is marked first") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {});
  const FaceFrameTable frames = make_face_frames(faces);
  const FaceLinkTable links = make_face_links(faces);
  // A corner that is finer and finer: to split its smallest leaves pulls ever larger neighbours along.
  PatchTable leaves = make_leaves(faces, frames, [](uint32_t) { return 1u; });
  std::vector<uint32_t> parent;
  for (int step = 0; step < 5; ++step) {
    std::vector<uint8_t> marks(leaves.size(), 0);
    marks[find_leaf(leaves, 0, find_cell(false, {0.499f, 0.499f}))] = 1;
    mark_for_balance(marks, leaves, frames, links);
    leaves = split_leaves(leaves, frames, marks, parent);
  }
  std::vector<uint32_t> candidates;
  std::vector<float> weight(leaves.size(), 0);
  for (uint32_t row = 0; row < leaves.size(); row += 2) {
    weight[row] = 1 / leaves.area[row] + 1e-3f * static_cast<float>(row);
    candidates.push_back(row);
  }
  uint64_t marked_most = 0;
  for (uint64_t budget = leaves.size(); budget < 4 * leaves.size(); ++budget) {
    const std::vector<uint8_t> marks = mark_within_budget(weight, leaves, frames, links, budget);
    PatchTable split = split_leaves(leaves, frames, marks, parent);
    CHECK(split.size() <= budget);
    const size_t size = split.size();
    balance_leaves(split, frames, links);
    CHECK(split.size() == size);
    // No candidate is left out for one of less weight, but for those that balance marks.
    std::vector<uint8_t> heaviest(leaves.size(), 0);
    float most_left = 0;
    for (const uint32_t row : candidates)
      if (!marks[row]) most_left = std::max(most_left, weight[row]);
    for (const uint32_t row : candidates) heaviest[row] = weight[row] > most_left;
    mark_for_balance(heaviest, leaves, frames, links);
    for (uint32_t row = 0; row < leaves.size(); ++row) CHECK(marks[row] <= heaviest[row]);
    const auto marked = static_cast<uint64_t>(std::count(marks.begin(), marks.end(), 1));
    marked_most = std::max(marked_most, marked);
  }
  CHECK(marked_most >= candidates.size());
}
