// Samples that depend on (seed, cell, purpose, index) alone, never on a thread or on time: counter-based
// hashing.
#pragma once

#include "engine/base/vector.h"

#include <array>

namespace patchlight {

// Mixes 64 bits so that every input bit reaches every output bit (Steele, Lea, Flood: Fast Splittable
// Pseudorandom Number Generators, 2014; the finaliser of SplitMix64).
inline uint64_t mix_bits(uint64_t x) {
  x ^= x >> 30, x *= 0xbf58476d1ce4e5b9ull;
  x ^= x >> 27, x *= 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

// A key for the samples of one cell of a face: any two cells, purposes or seeds have unrelated samples.
inline uint64_t make_ray_key(uint64_t seed, uint32_t face, uint32_t cell, uint32_t level, uint32_t purpose) {
  return mix_bits(mix_bits(seed * 0x9e3779b97f4a7c15ull + purpose) ^
                  mix_bits((uint64_t{face} << 32 | cell) + 0x632be59bd9b4e019ull * (level + 1)));
}

// 64 random bits for sample `index` of a key.
inline uint64_t make_sample_bits(uint64_t key, uint32_t index) {
  return mix_bits(key + 0x9e3779b97f4a7c15ull * (index + 1));
}
// Two numbers in [0, 1) of them, to 24 bits; three, to 21; four, to 16.
inline Vec2 make_jitter(uint64_t key, uint32_t index) {
  const uint64_t bits = make_sample_bits(key, index);
  return {static_cast<float>(bits >> 40) * 0x1p-24f, static_cast<float>(bits >> 8 & 0xffffff) * 0x1p-24f};
}
inline Vec3 make_jitter3(uint64_t key, uint32_t index) {
  const uint64_t bits = make_sample_bits(key, index);
  const auto part = [&](int shift) { return static_cast<float>(bits >> shift & 0x1fffff) * 0x1p-21f; };
  return {part(43), part(22), part(1)};
}
inline std::array<float, 4> make_jitter4(uint64_t key, uint32_t index) {
  const uint64_t bits = make_sample_bits(key, index);
  const auto part = [&](int shift) { return static_cast<float>(bits >> shift & 0xffff) * 0x1p-16f; };
  return {part(48), part(32), part(16), part(0)};
}

// Two unit vectors that complete a normal to a right-handed frame (Duff et al.: Building an Orthonormal
// Basis, Revisited, 2017).
struct Frame {
  Vec3 tangent, bitangent, normal;
};
inline Frame make_frame(Vec3 n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

// How far off its surface a ray starts, in lengths: a few units in the last place of the coordinates near it.
inline float ray_offset(Vec3 p) {
  return 2e-6f * std::max({0.25f, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}
// How far before its target a ray from `from` ends: tracers tell distances no better than the larger of both
// coordinates lets them.
inline float ray_offset(Vec3 from, Vec3 target) { return std::max(ray_offset(from), ray_offset(target)); }

}  // namespace patchlight
