// Shuffled Sobol points: strata, and keys.
#include "engine/base/sobol.h"

#include <doctest/doctest.h>

#include <vector>

using namespace patchlight;

TEST_CASE("any 256 points from a multiple of 256 on have one in each 256th, in every dimension") {
  for (const uint64_t key : {1, 2, 3}) {
    const Sobol sobol = make_sobol(key);
    for (const uint32_t first : {0u, 256u, 1024u, 1u << 20})
      for (size_t dimension = 0; dimension < 4; ++dimension) {
        std::vector<int> count(256);
        for (uint32_t k = first; k < first + 256; ++k)
          ++count[static_cast<size_t>(make_point(sobol, find_sobol_bits(k))[dimension] * 256)];
        CHECK((count == std::vector<int>(256, 1)));
      }
  }
}

TEST_CASE(
    "256 points have one in each cell of 16 x 16, in the pairs of dimensions that make points of faces") {
  const Sobol sobol = make_sobol(7);
  std::vector<int> count(256);
  for (uint32_t k = 0; k < 256; ++k) {
    const auto point = make_point(sobol, find_sobol_bits(k));
    ++count[static_cast<size_t>(point[0] * 16) * 16 + static_cast<size_t>(point[1] * 16)];
  }
  CHECK((count == std::vector<int>(256, 1)));
}

TEST_CASE("bits of a sum without common bits are the bits of both, flipped together") {
  const SobolBits sum = find_sobol_bits(0x1234'0056), high = find_sobol_bits(0x1234'0000),
                  low = find_sobol_bits(0x56);
  for (size_t d = 0; d < 4; ++d) CHECK(sum[d] == (high[d] ^ low[d]));
}

TEST_CASE("keys give unrelated points, whose mean is a half") {
  const auto a = make_point(make_sobol(1), find_sobol_bits(5)),
             b = make_point(make_sobol(2), find_sobol_bits(5));
  CHECK(a != b);
  double sum = 0;
  for (uint64_t key = 0; key < 4096; ++key) sum += make_point(make_sobol(key), find_sobol_bits(0))[3];
  // Four standard errors of the mean of uniform numbers: 4 sqrt(1 / 12 / 4096) = 0.018.
  CHECK(std::abs(sum / 4096 - 0.5) <= 0.018);
}
