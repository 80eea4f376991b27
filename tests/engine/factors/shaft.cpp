// What stands between two polygons: certain answers are right, and doubt is not left where it need not be.
#include "engine/factors/shaft.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

// The unit square, the one above it, and one more polygon.
Sight find_sight_past(const std::vector<std::vector<Vec3>>& others) {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  add_quad(faces, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}, {});
  for (const auto& other : others) add_polygon(faces, other, {});
  const PartTable parts = make_parts(faces, next_polygon(faces));
  std::array<ShaftEnd, 2> ends;
  for (uint32_t part = 0; part < 2; ++part) {
    const auto hull = part_hull(parts, part);
    ends[part] = {part, {hull.begin(), hull.end()}};
  }
  Blockers blockers;
  const Bvh tree = make_bvh(faces, parts);
  const Sight sight = find_sight(blockers, tree, faces, parts, ends[0], ends[1]);
  CHECK((find_sight(blockers, tree, faces, parts, ends[1], ends[0]) == sight));
  return sight;
}

std::vector<Vec3> make_level(float low, float high, float z) {
  return {{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}};
}

}  // namespace

TEST_CASE("nothing, what lies beside, behind, and what only touches leaves the sight clear") {
  CHECK((find_sight_past({}) == Sight::kClear));
  CHECK((find_sight_past({make_level(1.001f, 2, 0.5f)}) == Sight::kClear));
  CHECK((find_sight_past({make_level(0, 1, -0.1f)}) == Sight::kClear));
  CHECK((find_sight_past({make_level(0, 1, 1.1f)}) == Sight::kClear));
  // A wall of the room that both are in, one that leans outwards, a decal in the floor's own plane.
  CHECK((find_sight_past({{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}}) == Sight::kClear));
  CHECK((find_sight_past({{{1, 0, 0}, {1, 1, 0}, {2, 1, 1}, {2, 0, 1}}}) == Sight::kClear));
  CHECK((find_sight_past({make_level(0.2f, 0.8f, 0)}) == Sight::kClear));
  // Its box reaches between the two, it does not.
  CHECK((find_sight_past({{{1.6f, 0.5f, 0.5f}, {1.6f, 1.6f, 0.5f}, {0.5f, 1.6f, 0.5f}}}) == Sight::kClear));
}

TEST_CASE("what reaches between leaves doubt, however near it is to the one or the other") {
  CHECK((find_sight_past({make_level(0.4f, 0.6f, 0.5f)}) == Sight::kMixed));
  CHECK((find_sight_past({make_level(0.4f, 0.6f, 0.999f)}) == Sight::kMixed));
  CHECK((find_sight_past({make_level(0.4f, 0.6f, 1e-4f)}) == Sight::kMixed));
  CHECK((find_sight_past({make_level(0.99f, 2, 0.5f)}) == Sight::kMixed));
  CHECK((find_sight_past({{{0.5f, -1, 0}, {0.5f, 2, 0}, {0.5f, 2, 1}, {0.5f, -1, 1}}}) == Sight::kMixed));
  // Two halves hide all together, which no one of them does.
  CHECK(
      (find_sight_past({{{-1, -1, 0.5f}, {0.5f, -1, 0.5f}, {0.5f, 2, 0.5f}, {-1, 2, 0.5f}},
                        {{0.5f, -1, 0.5f}, {2, -1, 0.5f}, {2, 2, 0.5f}, {0.5f, 2, 0.5f}}}) == Sight::kMixed));
}

TEST_CASE("a polygon that covers the whole section between hides all") {
  CHECK((find_sight_past({make_level(0, 1, 0.5f)}) == Sight::kHidden));
  CHECK((find_sight_past({make_level(-1, 2, 0.001f)}) == Sight::kHidden));
  CHECK((find_sight_past({make_level(0.001f, 1, 0.5f)}) == Sight::kMixed));
  CHECK((find_sight_past({{{-1, -1, 0.1f}, {2, -1, 0.9f}, {2, 2, 0.9f}, {-1, 2, 0.1f}}}) == Sight::kHidden));
  CHECK((find_sight_past({make_level(0.4f, 0.6f, 0.2f), make_level(0, 1, 0.5f)}) == Sight::kHidden));
}

TEST_CASE("a tree finds a face among thousands") {
  std::vector<std::vector<Vec3>> others;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      const float x = 1.1f + 0.1f * static_cast<float>(i), y = 0.1f * static_cast<float>(j);
      others.push_back({{x, y, 0.5f}, {x + 0.05f, y, 0.5f}, {x + 0.05f, y + 0.05f, 0.6f}});
    }
  CHECK((find_sight_past(others) == Sight::kClear));
  others.push_back(make_level(0.5f, 0.51f, 0.3f));
  CHECK((find_sight_past(others) == Sight::kMixed));
}

TEST_CASE("a line between two parts is blocked by what crosses it, and by nothing that touches its ends") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  add_quad(faces, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}, {});
  add_polygon(faces, make_level(0.2f, 0.5f, 0.5f), {});
  add_polygon(faces, make_level(0.8f, 1, 0), {});
  const PartTable parts = make_parts(faces, next_polygon(faces));
  const Bvh tree = make_bvh(faces, parts);
  const auto blocked = [&](DVec3 from, DVec3 to) {
    const bool one = is_blocked(tree, faces, parts, 0, 1, from, to);
    CHECK(is_blocked(tree, faces, parts, 0, 1, to, from) == one);
    return one;
  };
  CHECK(blocked({0.3, 0.3, 0}, {0.3, 0.3, 1}));
  CHECK(blocked({0.3, 0.45, 0}, {0.45, 0.3, 1}));
  CHECK(!blocked({0.6, 0.3, 0}, {0.6, 0.3, 1}));
  CHECK(!blocked({0.9, 0.9, 0}, {0.9, 0.9, 1}));
  CHECK(blocked({0.1, 0.1, 0}, {0.5, 0.5, 1}));
}
