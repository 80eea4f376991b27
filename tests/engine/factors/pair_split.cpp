// Pairs cut into what is certain and what is not.
#include "engine/factors/pair_split.h"

#include "tests/form_factor_cases.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

struct Split {
  SplitPair split;
  double whole;  // exchange with nothing between
};
Split find_split(const std::vector<Corners>& blockers, double error) {
  FaceTable faces;
  add_polygon(faces, kSquare, {});
  add_polygon(faces, kAbove, {});
  for (const Corners& blocker : blockers) add_polygon(faces, blocker, {});
  const PartTable parts = make_parts(faces, next_polygon(faces));
  Split result;
  ContourScratch scratch;
  result.whole = find_exchange_area(part_outline(parts, 0), part_outline(parts, 1), 1e-9, scratch);
  split_pair(result.split, make_bvh(faces, parts), faces, parts, 0, 1, result.whole, error, 1e-9, scratch);
  return result;
}

const std::vector<Corners> kHalfScreen = {{{-2, -2, 0.5f}, {0.5f, -2, 0.5f}, {0.5f, 3, 0.5f}, {-2, 3, 0.5f}}};

}  // namespace

TEST_CASE("a pair that rays find cheaply is left whole") {
  const Split result = find_split(kHalfScreen, 0.1);
  REQUIRE(result.split.sub_pairs.size() == 1);
  CHECK(result.split.clear == 0);
  CHECK(result.split.sub_pairs[0].exchange == doctest::Approx(result.whole));
}

TEST_CASE("what is certain and what is not bracket the answer, closer with every split") {
  // Half of the light passes.
  double doubt = 1;
  for (const double error : {3e-4, 1e-4, 3e-5}) {
    CAPTURE(error);
    const Split result = find_split(kHalfScreen, error);
    CHECK(result.split.clear <= 0.5 * result.whole);
    CHECK(result.split.clear + result.split.mixed >= 0.5 * result.whole);
    CHECK(result.split.mixed < doubt);
    double sum = 0;
    for (const SubPair& pair : result.split.sub_pairs) sum += pair.exchange;
    CHECK(sum == doctest::Approx(result.split.mixed).epsilon(1e-6));
    doubt = result.split.mixed;
  }
}

TEST_CASE("a partition is found to part the pair exactly") {
  const Split result = find_split({{{0.5f, -1, 0}, {0.5f, 2, 0}, {0.5f, 2, 1}, {0.5f, -1, 1}}}, 1e-4);
  // Each half sees its own half: 0.116653691804 passes, and the planes of blockers are where pairs are cut.
  CHECK(std::abs(result.split.clear - 0.116653691804) <= 1e-6);
}
