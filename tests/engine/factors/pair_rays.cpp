// Rays between pairs: weights, shares, and their errors.
#include "engine/factors/pair_rays.h"

#include "engine/factors/polygon_factors.h"
#include "tests/form_factor_cases.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

std::vector<DVec3> to_double(const Corners& corners) { return {corners.begin(), corners.end()}; }

DVec3 find_normal(const Corners& corners) {
  return normalize(cross(DVec3(corners[1] - corners[0]), DVec3(corners[2] - corners[1])));
}

PairSums cast(const RayPairTable& pairs, const FaceTable& faces, uint32_t samples, uint64_t key = 1) {
  const Tracer tracer = make_tracer(faces);
  PairSums sums;
  SampleScratch scratch;
  while (sums.sample_count() < samples) add_samples(sums, pairs, tracer, make_sobol(key), scratch);
  return sums;
}

double find_mean_weight(const PairSums& sums) {
  double sum = 0;
  for (const double all : sums.all) sum += all;
  return sum / sums.sample_count() / std::numbers::pi;
}

FaceTable make_far_away() {
  FaceTable faces;
  add_triangle(faces, {9, 9, 9}, {9.1f, 9, 9}, {9, 9.1f, 9}, {});
  return faces;
}

}  // namespace

TEST_CASE("weights average 1: samples integrate the kernel, near, touching and far") {
  for (const auto* pairs : {&kFreePairs, &kHardPairs})
    for (const KnownPair& pair : *pairs) {
      // Pairs that reach behind each other's planes are clipped elsewhere.
      if (pair.factor_ab == 0 || pair.name.starts_with("horizon")) continue;
      CAPTURE(pair.name);
      FaceTable area;
      add_polygon(area, std::span(pair.a).first(3), {});
      double a = 0;
      for (size_t k = 2; k < pair.a.size(); ++k)
        a += 0.5 * length(cross(DVec3(pair.a[k - 1] - pair.a[0]), DVec3(pair.a[k] - pair.a[0])));
      RayPairTable table;
      clear_pairs(table);
      add_pair(table, to_double(pair.a), find_normal(pair.a), to_double(pair.b), find_normal(pair.b),
               a * pair.factor_ab);
      const PairSums sums = cast(table, make_far_away(), 4096);
      // 4096 stratified samples; random ones of weights between 0 and 3, say, would err by 0.02.
      CHECK(std::abs(find_mean_weight(sums) - 1) <= 0.02);
      CHECK(find_share(sums).value == 1);
      // All agree: the error is that of what they may have missed.
      CHECK(find_share(sums).error == doctest::Approx(1.0 / sums.sample_count()));
    }
}

TEST_CASE("half a screen lets half of the light pass, within the error that blocks tell") {
  FaceTable faces;
  add_polygon(faces, Corners{{-2, -2, 0.5f}, {0.5f, -2, 0.5f}, {0.5f, 3, 0.5f}, {-2, 3, 0.5f}}, {});
  RayPairTable table;
  clear_pairs(table);
  add_pair(table, to_double(kSquare), {0, 0, 1}, to_double(kAbove), {0, 0, -1}, 0.199824895698);
  uint32_t within = 0;
  double squares = 0;
  constexpr uint32_t kKeys = 40;
  for (uint64_t key = 0; key < kKeys; ++key) {
    const Share share = find_share(cast(table, faces, 512, key));
    const double error = std::abs(share.value - 0.5);
    within += error <= share.error;
    squares += error * error;
    CHECK(share.error < 0.03);
    CHECK(error <= 4.5 * share.error);
  }
  // Random pairs would err by 0.5 / sqrt(512) = 0.022. Of normal errors 68 % are within one standard error.
  CHECK(std::sqrt(squares / kKeys) < 0.011);
  CHECK(within > 0.6 * kKeys);
}

TEST_CASE("samples are added by quarters, in blocks of one size, and depend on the key alone") {
  RayPairTable table;
  clear_pairs(table);
  add_pair(table, to_double(kSquare), {0, 0, 1}, to_double(kAbove), {0, 0, -1}, 0.2);
  const FaceTable faces = make_far_away();
  const Tracer tracer = make_tracer(faces);
  PairSums sums;
  SampleScratch scratch;
  for (const uint32_t expected : {16, 32, 48, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320}) {
    add_samples(sums, table, tracer, make_sobol(5), scratch);
    CHECK(sums.sample_count() == expected);
  }
  const PairSums again = cast(table, faces, 320, 5);
  CHECK((again.all == sums.all));
  CHECK((again.seen == sums.seen));
}

TEST_CASE("pairs are sampled in proportion to what they exchange") {
  // The left half of the light is blocked, the right half is not: as two pairs.
  FaceTable faces;
  add_polygon(faces, Corners{{-1, -1, 0.5f}, {1.5f, -1, 0.5f}, {1.5f, 2, 0.5f}, {-1, 2, 0.5f}}, {});
  const Corners low = {{4, 0, 0}, {5, 0, 0}, {5, 1, 0}, {4, 1, 0}},
                high = {{4, 1, 1}, {5, 1, 1}, {5, 0, 1}, {4, 0, 1}};
  RayPairTable table;
  clear_pairs(table);
  constexpr double kExchange = 0.199824895698;
  add_pair(table, to_double(kSquare), {0, 0, 1}, to_double(kAbove), {0, 0, -1}, kExchange);
  add_pair(table, to_double(low), {0, 0, 1}, to_double(high), {0, 0, -1}, kExchange);
  const Share share = find_share(cast(table, faces, 1024));
  CHECK(std::abs(share.value - 0.5) <= 0.01);
}
