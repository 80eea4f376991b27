// Points of four dimensions that fill space evenly, and differently for every key.
#pragma once

#include "engine/base/sampling.h"

#include <array>
#include <bit>

namespace patchlight {

// Sobol's sequence in four dimensions with a nested random shuffle of its own in each: any 2^k points from a
// multiple of 2^k on are stratified. (Sobol: On the Distribution of Points in a Cube, 1967, with the
// direction numbers of Joe, Kuo: Constructing Sobol Sequences with Better Two-Dimensional Projections, 2008;
// Owen: Randomly Permuted (t,m,s)-Nets, 1995, by a hash: Laine, Karras: Stratified Sampling for Stochastic
// Transparency, 2011, with the constants of Vegdahl in Burley: Practical Hash-Based Owen Scrambling, 2020.)
struct Sobol {
  std::array<uint32_t, 4> key;
};

namespace sobol_detail {

// Columns of the generator matrices, the first bit of a number lowest: so the hash below wants them.
using Columns = std::array<std::array<uint32_t, 32>, 4>;
constexpr Columns make_columns() {
  struct Start {
    uint32_t degree, inner;  // of the primitive polynomial: its degree, its inner coefficients
    std::array<uint32_t, 3> odd;
  };
  constexpr std::array<Start, 3> kStarts = {{{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};
  Columns columns{};
  for (uint32_t k = 0; k < 32; ++k) columns[0][k] = 1u << k;
  for (size_t d = 0; d < kStarts.size(); ++d) {
    const auto& [degree, inner, odd] = kStarts[d];
    std::array<uint32_t, 32> v{};
    for (uint32_t k = 0; k < 32; ++k) {
      if (k < degree) {
        v[k] = odd[k] << (31 - k);
        continue;
      }
      v[k] = v[k - degree] ^ v[k - degree] >> degree;
      for (uint32_t j = 1; j < degree; ++j)
        if (inner >> (degree - 1 - j) & 1u) v[k] ^= v[k - j];
    }
    for (uint32_t k = 0; k < 32; ++k)
      for (uint32_t bit = 0; bit < 32; ++bit) columns[d + 1][k] |= (v[k] >> (31 - bit) & 1u) << bit;
  }
  return columns;
}
inline constexpr Columns kColumns = make_columns();

constexpr uint32_t reverse_bits(uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
  return x >> 16 | x << 16;
}

}  // namespace sobol_detail

inline Sobol make_sobol(uint64_t key) {
  Sobol sobol{};
  for (uint32_t d = 0; d < 4; ++d)
    sobol.key[d] = static_cast<uint32_t>(mix_bits(key + 0x9e3779b97f4a7c15ull * (d + 1)) >> 32);
  return sobol;
}

// What the sequence has for a number, before it is shuffled. The bits of a sum of numbers without a common
// bit are those of both, each flipped where the other has them (x ^ y).
using SobolBits = std::array<uint32_t, 4>;
constexpr SobolBits find_sobol_bits(uint32_t index) {
  SobolBits bits{};
  for (uint32_t d = 0; d < 4; ++d)
    for (uint32_t rest = index; rest != 0; rest &= rest - 1)
      bits[d] ^= sobol_detail::kColumns[d][std::countr_zero(rest)];
  return bits;
}

// Four numbers in [0, 1).
inline std::array<double, 4> make_point(const Sobol& sobol, SobolBits bits) {
  std::array<double, 4> point{};
  for (uint32_t d = 0; d < 4; ++d) {
    uint32_t x = bits[d] + sobol.key[d];
    x ^= x * 0x6c50b47cu, x ^= x * 0xb82f1e52u, x ^= x * 0xc7afe638u, x ^= x * 0x8d22f6e6u;
    point[d] = sobol_detail::reverse_bits(x) * 0x1p-32;
  }
  return point;
}

}  // namespace patchlight
