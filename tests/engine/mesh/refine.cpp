#include "engine/mesh/refine.h"

#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

using namespace patchlight;

namespace {

// A square of 8 x 8 leaves with edges of 1/8, dark on the left, bright on the right.
struct Field {
  std::shared_ptr<const Surfaces> surfaces;
  PatchTable elements;
  std::vector<Rgb> direct;
  std::vector<float> error;
  std::vector<uint32_t> fresh;
};

Field make_field(float dark, float bright) {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, make_surface(0, 0.5f));
  Field field;
  field.surfaces = make_surfaces(faces);
  field.elements = make_leaves(faces, field.surfaces->frames, [](uint32_t) { return 3u; });
  for (uint32_t row = 0; row < 64; ++row) {
    const Vec3 c = cell_centre(field.surfaces->frames, 0, field.elements.cell[row], 3);
    field.elements.radiosity[row] = Rgb(0, c.x < 0.5f ? dark : bright, 0);
  }
  field.direct.assign(64, Rgb(0));
  field.error.assign(64, 0);
  field.fresh.resize(64);
  std::iota(field.fresh.begin(), field.fresh.end(), 0u);
  return field;
}

std::vector<uint8_t> mark(const Field& field, float threshold, float size_min, uint64_t budget, float mean) {
  const std::vector<float> sizes(field.elements.size(), size_min);
  return mark_differing({field.elements, field.direct, field.error, field.fresh, mean}, *field.surfaces,
                        {threshold, sizes, budget});
}

ptrdiff_t count_marked(const std::vector<uint8_t>& marks) {
  return std::count(marks.begin(), marks.end(), 1);
}

constexpr uint64_t kPlenty = 100000;

}  // namespace

TEST_CASE("refine: both of two neighbours that differ by more than the threshold are marked, and no others") {
  const Field field = make_field(0.8f, 1);
  // 0.2 of the larger one.
  const auto marks = mark(field, 0.19f, 0, kPlenty, 0);
  for (uint32_t row = 0; row < 64; ++row) {
    const Vec3 c = cell_centre(field.surfaces->frames, 0, field.elements.cell[row], 3);
    CHECK(marks[row] == (std::abs(c.x - 0.5f) < 0.1f ? 1 : 0));
  }
  CHECK(count_marked(marks) == 16);
  CHECK(count_marked(mark(field, 0.21f, 0, kPlenty, 0)) == 0);
}

TEST_CASE("refine: the largest channel decides") {
  Field field = make_field(0.5f, 0.5f);
  for (uint32_t row = 0; row < 64; ++row) field.elements.radiosity[row].b = row < 32 ? 0.5f : 0.3f;
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0)) == 16);
}

TEST_CASE("refine: differences below a hundredth of the scene's mean are not seen") {
  const Field field = make_field(0.001f, 0.002f);
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0.09f)) == 16);
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0.11f)) == 0);
}

TEST_CASE("refine: a difference that noise explains splits nothing") {
  Field field = make_field(0.8f, 1);
  // The rule may take any margin of at least two standard errors of the difference.
  std::fill(field.error.begin(), field.error.end(), 0.2f);
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0)) == 0);
  std::fill(field.error.begin(), field.error.end(), 0.001f);
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0)) == 16);
}

TEST_CASE("refine: leaves with edges below the least size stay") {
  const Field field = make_field(0, 1);
  CHECK(count_marked(mark(field, 0.1f, 0.12f, kPlenty, 0)) == 16);
  CHECK(count_marked(mark(field, 0.1f, 0.13f, kPlenty, 0)) == 0);
}

TEST_CASE("refine: the budget is kept, and the largest differences go first") {
  Field field = make_field(0.5f, 1);
  for (uint32_t row = 0; row < 64; ++row) {
    const Vec3 c = cell_centre(field.surfaces->frames, 0, field.elements.cell[row], 3);
    if (c.y > 0.75f && c.x > 0.5f) field.elements.radiosity[row] *= 10.0f;
  }
  for (const uint64_t budget : {0ull, 63ull, 64ull, 66ull, 67ull, 80ull, 90ull}) {
    const auto marks = mark(field, 0.1f, 0, budget, 0);
    if (budget <= 66) CHECK(count_marked(marks) == 0);
    if (budget > 66) CHECK(count_marked(marks) > 0);
    CHECK(64 + 3 * static_cast<uint64_t>(count_marked(marks)) <= std::max<uint64_t>(budget, 64));
    for (uint32_t row = 0; row < 64; ++row)
      if (marks[row]) CHECK(cell_centre(field.surfaces->frames, 0, field.elements.cell[row], 3).y > 0.6f);
  }
}

TEST_CASE("refine: only leaves not compared yet, with their neighbours, are looked at") {
  Field field = make_field(0, 1);
  field.fresh = {0, 1, 2};  // in a dark corner
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0)) == 0);
  field.fresh.clear();
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0)) == 0);
  field.fresh = {find_leaf(field.elements, 0, find_cell(false, {0.45f, 0.1f}))};
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0)) == 2);
}

TEST_CASE("refine: buried leaves are not compared") {
  Field field = make_field(0, 1);
  for (uint32_t row = 0; row < 64; ++row)
    if (cell_centre(field.surfaces->frames, 0, field.elements.cell[row], 3).x < 0.5f)
      field.elements.exposed[row] = 0;
  CHECK(count_marked(mark(field, 0.1f, 0, kPlenty, 0)) == 0);
}

TEST_CASE("refine: the tree stays balanced and is not split below the deepest level") {
  Field field = make_field(0, 1);
  for (uint32_t round = 0; round < 20; ++round) {
    for (uint32_t row = 0; row < field.elements.size(); ++row) {
      const Vec3 c =
          cell_centre(field.surfaces->frames, 0, field.elements.cell[row], field.elements.level[row]);
      // A bright spot about an inner point.
      field.elements.radiosity[row] = Rgb(distance(c, Vec3(0.3f, 0.4f, 0)) < 0.0001f ? 1.0f : 0.0f);
      if (find_leaf(field.elements, 0, find_cell(false, {0.3f, 0.4f})) == row)
        field.elements.radiosity[row] = Rgb(1);
    }
    field.error.assign(field.elements.size(), 0);
    field.fresh.resize(field.elements.size());
    std::iota(field.fresh.begin(), field.fresh.end(), 0u);
    const auto marks = mark(field, 0.1f, 0, kPlenty, 0);
    if (count_marked(marks) == 0) break;
    std::vector<uint32_t> parent;
    field.elements = split_leaves(field.elements, field.surfaces->frames, marks, parent);
    for (uint32_t row = 0; row < field.elements.size(); ++row)
      for (uint32_t edge = 0; edge < 4; ++edge) {
        const uint32_t other =
            find_coarse_neighbour(field.elements, field.surfaces->frames, field.surfaces->links, row, edge);
        if (other != kNone) REQUIRE(field.elements.level[row] - field.elements.level[other] <= 1);
      }
  }
  const uint32_t deepest = *std::max_element(field.elements.level.begin(), field.elements.level.end());
  CHECK(deepest >= kLevelMax - 2);
  CHECK(deepest < kLevelMax);
}

TEST_CASE(
    "refine: a split is told by what its greatest difference is made of, and by balance where there is "
    "none") {
  Field field = make_field(0.8f, 1);
  // Below, the difference is one of direct light; above, direct light is even.
  for (uint32_t row = 0; row < 64; ++row) {
    const Vec3 c = cell_centre(field.surfaces->frames, 0, field.elements.cell[row], 3);
    if (c.x > 0.5f && c.y < 0.5f) field.direct[row] = Rgb(0, 0.4f, 0);
  }
  std::vector<uint8_t> marks = mark(field, 0.1f, 0, kPlenty, 0);
  const uint32_t far = 0;  // a corner, whose neighbours are as bright as it is
  marks[far] = 1;
  std::vector<SplitReason> reasons(64, SplitReason::kStart);
  find_split_reasons(reasons, marks, {field.elements, field.direct, field.error, field.fresh, 0},
                     *field.surfaces, 0.1f);
  for (uint32_t row = 0; row < 64; ++row) {
    const Vec3 c = cell_centre(field.surfaces->frames, 0, field.elements.cell[row], 3);
    SplitReason expected = SplitReason::kStart;
    if (row == far) expected = SplitReason::kBalance;
    if (row != far && marks[row]) expected = c.y < 0.5f ? SplitReason::kDirect : SplitReason::kIndirect;
    CHECK((reasons[row] == expected));
  }
}
