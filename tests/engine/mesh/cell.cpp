#include "engine/mesh/cell.h"

#include "engine/base/sampling.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <set>

using namespace patchlight;

namespace {

FaceTable make_shapes() {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {});
  add_triangle(faces, {0.2f, 0, 0.5f}, {1, 0.3f, 0}, {0.1f, 0.9f, 0.7f}, {});
  add_quad(faces, {0, 0, 0}, {0.4f, 0, 0.4f}, {0.3f, 1, 0.3f}, {0.1f, 0.6f, 0.1f}, {});  // no parallelogram
  add_quad(faces, {-1, 0, 0}, {1, 0, 0}, {0.05f, 0, -1}, {-0.05f, 0, -1}, {});           // nearly a triangle
  add_quad(faces, {5, 5, 5}, {6, 5, 5}, {7, 6, 5}, {6, 6, 5}, {});                       // sheared
  return faces;
}

// A cell of a level by a number: its path is the number's base-4 digits.
uint32_t make_cell(uint64_t number, uint32_t level) {
  return static_cast<uint32_t>(number * cell_span(level));
}

uint64_t pick_number(uint32_t level, uint64_t key) { return mix_bits(key) % (uint64_t{1} << 2 * level); }

}  // namespace

TEST_CASE("cell codes: children share out the span of their parent in order") {
  for (uint32_t level = 0; level < kLevelMax; ++level) {
    const uint32_t cell = make_cell(pick_number(level, level), level);
    CHECK(cell_span(level) == 4 * cell_span(level + 1));
    for (uint32_t child = 0; child < 4; ++child) {
      const auto code = static_cast<uint32_t>(cell + child * cell_span(level + 1));
      CHECK(cell_child(code, level + 1) == child);
      CHECK(cell_ancestor(code, level) == cell);
      CHECK(cell_ancestor(code, level + 1) == code);
    }
  }
  CHECK(cell_ancestor(0xffffffffu, 0) == 0);
}

TEST_CASE("cell codes: a sample of a cell finds that cell again, at every level, in quads and in triangles") {
  for (const bool triangle : {false, true})
    for (uint32_t level = 0; level <= kLevelMax; ++level)
      for (uint64_t trial = 0; trial < 200; ++trial) {
        const uint32_t cell = make_cell(pick_number(level, 1000 * level + trial), level);
        // Two percent off the border of the cell, which two cells share: at level 16 a cell still holds 256
        // floats.
        const Vec2 p = 0.02f + 0.96f * make_jitter(trial, level);
        const Vec2 uv = cell_sample(triangle, make_cell_frame(triangle, cell, level), p);
        REQUIRE(cell_ancestor(find_cell(triangle, uv), level) == cell);
      }
}

TEST_CASE("cell codes: all cells of a level are different places") {
  for (const bool triangle : {false, true}) {
    std::set<std::pair<float, float>> places;
    for (uint32_t number = 0; number < 256; ++number) {
      const CellFrame frame = make_cell_frame(triangle, make_cell(number, 4), 4);
      const Vec2 centre = frame.origin + Vec2(frame.size * (triangle ? 1 / 3.0f : 0.5f));
      places.insert({centre.x, centre.y});
      CHECK(std::abs(frame.size) == 1 / 16.0f);
    }
    CHECK(places.size() == 256);
  }
}

TEST_CASE("cell codes: parameters outside the face belong to the nearest border") {
  CHECK(find_cell(false, {-3, -1}) == 0);
  CHECK(find_cell(false, {2, 9}) == 0xffffffffu);
  CHECK(find_cell(false, {1, 1}) == 0xffffffffu);
  CHECK(find_cell(true, {-1, -1}) == 0);
  CHECK(cell_child(find_cell(true, {2, 0}), 1) == 1);
  CHECK(cell_child(find_cell(true, {0, 2}), 1) == 2);
  // Beyond the long side: drawn in along the ray from corner 0.
  CHECK(find_cell(true, {1, 1}) == find_cell(true, {0.5f, 0.5f}));
  CHECK(find_cell(true, {4, 0.5f}) == find_cell(true, {1, 0.5f}));
}

TEST_CASE("cell samples are uniform: every descendant gets its share, the mean is the centre") {
  constexpr uint32_t kSide = 128;
  for (const bool triangle : {false, true}) {
    std::array<uint32_t, 16> count{};
    DVec2 sum(0);
    for (uint32_t k = 0; k < kSide * kSide; ++k) {
      const Vec2 p((static_cast<float>(k % kSide) + 0.5f) / kSide,
                   (static_cast<float>(k / kSide) + 0.5f) / kSide);
      const Vec2 uv = cell_sample(triangle, {Vec2(0), 1}, p);
      ++count[find_cell(triangle, uv) >> 28];
      sum += DVec2(uv);
    }
    // Grid points on the border of two cells may go either way: a row of them along the four sides of a cell.
    for (const uint32_t n : count) CHECK(std::abs(static_cast<int>(n) - 1024) <= 4 * 64);
    const double centre = triangle ? 1.0 / 3 : 0.5;
    // The midpoint rule on 128 x 128 cells of a piecewise linear map.
    CHECK(std::abs(sum.x / (kSide * kSide) - centre) <= 1.0 / kSide / kSide);
    CHECK(std::abs(sum.y / (kSide * kSide) - centre) <= 1.0 / kSide / kSide);
  }
}

TEST_CASE("areas of children sum to their parent's, and those of the roots are the faces' own") {
  const FaceTable faces = make_shapes();
  const FaceFrameTable frames = make_face_frames(faces);
  for (uint32_t face = 0; face < faces.size(); ++face) {
    CHECK(cell_area(frames, face, 0, 0) == doctest::Approx(face_area(faces, face)).epsilon(1e-6));
    for (uint32_t level = 0; level < 8; ++level) {
      const uint32_t cell = make_cell(pick_number(level, face), level);
      double sum = 0;
      for (uint32_t child = 0; child < 4; ++child)
        sum += cell_area(frames, face, static_cast<uint32_t>(cell + child * cell_span(level + 1)), level + 1);
      // Corners in float: a part in 2^22 of the face, so more of a small cell.
      const double error = 4e-6 * std::ldexp(1.0, static_cast<int>(level));
      CHECK(sum == doctest::Approx(cell_area(frames, face, cell, level)).epsilon(error));
    }
  }
}

TEST_CASE("cells of a face turn the way the face does, turned cells of a triangle too") {
  const FaceTable faces = make_shapes();
  const FaceFrameTable frames = make_face_frames(faces);
  for (uint32_t face = 0; face < faces.size(); ++face)
    for (uint32_t number = 0; number < 64; ++number) {
      const auto c = cell_corners(frames, face, make_cell(number, 3), 3);
      CHECK(dot(cross(c[1] - c[0], c[2] - c[0]), faces.normal[face]) > 0);
      CHECK(longest_edge(c) > 0);
    }
}

TEST_CASE("parameters of a point give the point back, on skewed and on nearly triangular quads") {
  const FaceTable faces = make_shapes();
  const FaceFrameTable frames = make_face_frames(faces);
  CHECK(frames.affine[0] == 1);
  CHECK(frames.affine[2] == 0);
  CHECK(frames.affine[4] == 1);
  for (uint32_t face = 0; face < faces.size(); ++face)
    for (uint32_t trial = 0; trial < 1000; ++trial) {
      const Vec2 uv = cell_sample(frames.triangle[face], {Vec2(0), 1}, make_jitter(face, trial));
      const Vec3 point = face_point(frames, face, uv);
      const Vec2 found = find_face_parameters(frames, face, point);
      // A few roundings of the coordinates, at most 7.
      REQUIRE(distance(face_point(frames, face, found), point) <= 16 * 0x1p-24f * 7);
      REQUIRE(found.x >= -1e-4f);
      REQUIRE(found.x <= 1 + 1e-4f);
    }
}

TEST_CASE("the centre of a cell lies in it, and its corners are face corners at level 0") {
  const FaceTable faces = make_shapes();
  const FaceFrameTable frames = make_face_frames(faces);
  for (uint32_t face = 0; face < faces.size(); ++face) {
    const auto corners = cell_corners(frames, face, 0, 0);
    for (size_t k = 0; k < 4; ++k) CHECK(distance(corners[k], faces.corners[face][k]) <= 4 * 0x1p-24f * 7);
    for (uint32_t number = 0; number < 256; ++number) {
      const uint32_t cell = make_cell(number, 4);
      const Vec2 uv = find_face_parameters(frames, face, cell_centre(frames, face, cell, 4));
      CHECK(cell_ancestor(find_cell(frames.triangle[face], uv), 4) == cell);
    }
  }
}
