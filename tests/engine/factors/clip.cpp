// Polygons and outlines cut at a plane.
#include "engine/factors/clip.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

const std::vector<DVec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

std::vector<Segment> make_outline(const std::vector<DVec3>& corners) {
  std::vector<Segment> outline;
  for (size_t k = 0; k < corners.size(); ++k)
    outline.push_back({corners[k], corners[(k + 1) % corners.size()]});
  return outline;
}

// Twice the signed area, by its outline alone.
double find_area(const std::vector<Segment>& outline) {
  double sum = 0;
  for (const auto& [a, b] : outline) sum += cross(a, b).z;
  return sum / 2;
}

}  // namespace

TEST_CASE("a square cut at a quarter of its width keeps three quarters") {
  std::vector<DVec3> kept;
  CHECK(clip_polygon(kept, kSquare, {{1, 0, 0}, 0.25}) == 4);
  CHECK(find_area(make_outline(kept)) == doctest::Approx(0.75).epsilon(1e-15));
  std::vector<Segment> outline;
  clip_outline(outline, make_outline(kSquare), {{1, 0, 0}, 0.25});
  CHECK(find_area(outline) == doctest::Approx(0.75).epsilon(1e-15));
}

TEST_CASE("a corner cut off adds one, and what lies behind the plane goes") {
  std::vector<DVec3> kept;
  CHECK(clip_polygon(kept, kSquare, {{-1, -1, 0}, -1.5}) == 5);
  kept.clear();
  CHECK(clip_polygon(kept, kSquare, {{1, 0, 0}, 2}) == 0);
  CHECK(clip_polygon(kept, kSquare, {{1, 0, 0}, -2}) == 4);
  std::vector<Segment> outline;
  clip_outline(outline, make_outline(kSquare), {{1, 0, 0}, 2});
  CHECK(outline.empty());
  clip_outline(outline, make_outline(kSquare), {{1, 0, 0}, -2});
  CHECK(outline.size() == 4);
}

TEST_CASE("an outline that is not convex, with a hole, keeps the area before the plane") {
  // A comb with two teeth, y from 0 to 3, a hole in its back, cut across the teeth and across the hole.
  std::vector<Segment> outline =
      make_outline({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  const std::vector<Segment> hole = make_outline({{1, 0.25, 0}, {1, 0.75, 0}, {2, 0.75, 0}, {2, 0.25, 0}});
  outline.insert(outline.end(), hole.begin(), hole.end());
  CHECK(find_area(outline) == doctest::Approx(6.5).epsilon(1e-15));
  std::vector<Segment> kept;
  clip_outline(kept, outline, {{0, 1, 0}, 2});
  CHECK(find_area(kept) == doctest::Approx(2).epsilon(1e-15));
  kept.clear();
  clip_outline(kept, outline, {{0, -1, 0}, -0.5});
  CHECK(find_area(kept) == doctest::Approx(1.25).epsilon(1e-15));
}
