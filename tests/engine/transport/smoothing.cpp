// Smoothing on fields whose truth is known.
#include "engine/transport/smoothing.h"

#include "engine/base/sampling.h"
#include "engine/mesh/quadtree.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

constexpr uint32_t kStrengths = 7;

// A unit square in the plane z = 0, cut into 4^level leaves; one of the leaves is split once more, with what
// balance asks for.
struct Square {
  FaceTable faces;
  std::shared_ptr<const Surfaces> surfaces;
  PatchTable leaves;
  SmoothingTable smoothing;
};
Square make_square(uint32_t level, bool graded) {
  Square square;
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  add_polygon(square.faces, corners, make_surface(0, 0.5f));
  square.surfaces = make_surfaces(square.faces);
  square.leaves = make_leaves(square.faces, square.surfaces->frames, [&](uint32_t) { return level; });
  if (graded) {
    std::vector<uint8_t> marks(square.leaves.size(), 0);
    for (size_t row = marks.size() / 4; row < marks.size() / 2; ++row) marks[row] = 1;
    std::vector<uint32_t> parent;
    square.leaves = split_leaves(square.leaves, square.surfaces->frames, marks, parent);
  }
  square.leaves.exposed.assign(square.leaves.size(), 1);
  square.smoothing = make_smoothing(square.leaves, *square.surfaces, all_rows(square.leaves.size()));
  return square;
}

Vec3 centre_of(const Square& square, size_t row) {
  const auto [face, cell, level] = name_cell(square.leaves, row);
  return cell_centre(square.surfaces->frames, face, cell, level);
}

// About normal, of standard deviation 1: the sum of twelve even numbers.
float make_noise(uint64_t key, size_t row) {
  float sum = -6;
  for (uint32_t k = 0; k < 6; ++k) {
    const Vec2 sample = make_jitter(mix_bits(key), static_cast<uint32_t>(6 * row + k));
    sum += sample.x + sample.y;
  }
  return sum;
}

struct Field {
  std::vector<Rgb> value;
  std::vector<float> noise, error;
};
// truth(centre) with noise of this standard deviation, and an independent sample of the same noise.
template <typename Truth>
Field make_field(const Square& square, float deviation, uint64_t seed, const Truth& truth) {
  Field field;
  for (size_t row = 0; row < square.leaves.size(); ++row) {
    field.value.emplace_back(truth(centre_of(square, row)) + deviation * make_noise(2 * seed, row));
    field.noise.push_back(deviation * make_noise(2 * seed + 1, row));
  }
  field.error.resize(field.value.size());
  return field;
}

template <typename Truth>
double find_rms(const Square& square, const Field& field, const Truth& truth) {
  double sum = 0;
  for (size_t row = 0; row < field.value.size(); ++row)
    sum += std::pow(double{field.value[row].g} - double{truth(centre_of(square, row))}, 2);
  return std::sqrt(sum / static_cast<double>(field.value.size()));
}

double find_told(const Field& field) {
  double sum = 0;
  for (const float error : field.error) sum += double{error} * error;
  return std::sqrt(sum / static_cast<double>(field.error.size()));
}

}  // namespace

TEST_CASE("smoothing: light without noise stays as it is, however it bends") {
  for (const bool graded : {false, true}) {
    const Square square = make_square(4, graded);
    const auto truth = [](Vec3 p) { return 1 + p.x * p.x + 0.5f * std::sin(9 * p.y); };
    Field field = make_field(square, 0, 1, truth);
    const std::vector<Rgb> before = field.value;
    smooth_noise({field.value, field.noise, field.error}, square.smoothing, kStrengths);
    for (size_t row = 0; row < before.size(); ++row)
      // Where a step changes nothing in the mean of the squares, it may be taken: rounding.
      CHECK(std::abs(field.value[row].g - before[row].g) <= 1e-5f);
  }
}

TEST_CASE("smoothing: a constant slope keeps its values and loses its noise") {
  for (const bool graded : {false, true}) {
    const Square square = make_square(5, graded);
    const auto truth = [](Vec3 p) { return 2 + p.x - 0.5f * p.y; };
    double before = 0, after = 0, told = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
      Field field = make_field(square, 0.05f, seed, truth);
      before += find_rms(square, field, truth);
      smooth_noise({field.value, field.noise, field.error}, square.smoothing, kStrengths);
      after += find_rms(square, field, truth);
      told += find_told(field);
    }
    // 32 steps of half a leaf spread over some 50 leaves, a seventh of the noise; the border takes part along
    // itself alone and is an eighth of all leaves.
    CHECK(after < 0.4 * before);
    CHECK(told < 2 * after);
    CHECK(told > after / 2);
  }
}

TEST_CASE("smoothing: an edge of the light stays where it is") {
  const Square square = make_square(5, false);
  const auto truth = [](Vec3 p) { return p.x < 0.5f ? 1.0f : 2.0f; };
  Field field = make_field(square, 0.02f, 1, truth);
  smooth_noise({field.value, field.noise, field.error}, square.smoothing, kStrengths);
  for (size_t row = 0; row < field.value.size(); ++row) {
    const Vec3 centre = centre_of(square, row);
    // Five standard deviations of a leaf that keeps its noise.
    CHECK(std::abs(field.value[row].g - truth(centre)) < 5 * 0.02f);
  }
  CHECK(find_rms(square, field, truth) < 0.02);
}

TEST_CASE("smoothing: leaves that lie buried take no part") {
  Square square = make_square(3, false);
  for (size_t row = 0; row < square.leaves.size(); row += 3) square.leaves.exposed[row] = 0;
  square.smoothing = make_smoothing(square.leaves, *square.surfaces, all_rows(square.leaves.size()));
  for (const uint32_t leaf : square.smoothing.leaf) CHECK(square.leaves.exposed[leaf] > 0);
  for (const uint32_t leaf : square.smoothing.neighbour) CHECK(square.leaves.exposed[leaf] > 0);
  for (size_t entry = 0; entry < square.smoothing.size(); ++entry) {
    float sum = 0;
    for (uint32_t k = square.smoothing.first[entry]; k < square.smoothing.first[entry + 1]; ++k)
      sum += square.smoothing.weight[k];
    CHECK(std::abs(sum - 1) <= 1e-6f);
  }
}

TEST_CASE("smoothing: power that smoothing moved over a polygon's border is given back") {
  const Square square = make_square(4, true);
  Field field = make_field(square, 0.1f, 3, [](Vec3 p) { return 1 + p.x; });
  const std::vector<Rgb> before = field.value;
  smooth_noise({field.value, field.noise, field.error}, square.smoothing, kStrengths);
  keep_power(field.value, before, square.smoothing, square.leaves, square.faces);
  double sums[2] = {0, 0};
  for (size_t row = 0; row < before.size(); ++row) {
    sums[0] += double{square.leaves.area[row]} * before[row].g;
    sums[1] += double{square.leaves.area[row]} * field.value[row].g;
  }
  // Rounding of a float a leaf.
  CHECK(std::abs(sums[1] / sums[0] - 1) <= 1e-6);
}
