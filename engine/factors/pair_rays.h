// Pairs of surfaces with something between them to the share of their light that passes, by rays.
#pragma once

#include "engine/base/sobol.h"
#include "engine/factors/shaft.h"
#include "engine/trace/tracer.h"

#include <span>
#include <vector>

namespace patchlight {

// Where rays of double precision are asked for: the scene, and the two parts that all pairs are of.
struct FineRays {
  const Bvh& tree;
  const FaceTable& faces;
  const PartTable& parts;
  uint32_t part_a, part_b;
};

// Pairs of convex polygons that are sampled together, each in proportion to its exchange.
struct RayPairTable {
  std::vector<double> exchange_until;  // lengths squared: of the pairs up to this one, with nothing between
  std::vector<double> exchange_inverse;
  std::vector<DVec3> normal_from, normal_to;
  std::vector<uint32_t> triangle_first;  // pairs + 1: those of `from`, then
  std::vector<uint32_t> triangle_to;     // those of `to`
  std::vector<uint8_t> far;              // 1: far apart for their size
  std::vector<std::array<DVec3, 3>> triangle;
  std::vector<double> area_until;  // a row a triangle: of the triangles of its polygon up to it
  // Lengths: how much further than others its rays stay away from what they leave and from what they end at,
  // whose corners may lie off one plane.
  float off_plane = 0;
  DVec3 shift{0};                  // PartTable::shift
  const FineRays* fine = nullptr;  // rays of single precision, unless it is set
  size_t size() const { return exchange_until.size(); }
};
void clear_pairs(RayPairTable& pairs);
// Both polygons lie wholly before each other's planes, and exchange more than 0.
void add_pair(RayPairTable& pairs, std::span<const DVec3> from, DVec3 normal_from, std::span<const DVec3> to,
              DVec3 normal_to, double exchange);

// Sums over blocks of samples, all of one size: `all` of the light that would pass if nothing were between,
// `seen` of what passes.
constexpr uint32_t kBlocksMin = 16;
struct PairSums {
  std::array<double, 2 * kBlocksMin> all{}, seen{};
  uint32_t block_count = 0, block_size = 1;
  uint32_t sample_count() const { return block_count * block_size; }
};

// Memory that is reused from call to call.
struct SampleScratch {
  std::vector<std::array<double, 4>> points;
  std::vector<uint32_t> block;
  std::vector<std::array<DVec3, 3>> directions;  // of the corners of triangles, from one point
  std::vector<double> angle_until;               // steradians: of the triangles up to this one
};

// Adds a quarter to the samples, or sixteen: a pair, a point of `from` even in its area, and a point of `to`
// even in the solid angle that it has there (Arvo: Stratified Sampling of Spherical Triangles, 1995), which
// leaves to the sums a weight that is never large, however near the two are; far pairs take it even in the
// area. Samples are a function of the key and their number.
void add_samples(PairSums& sums, const RayPairTable& pairs, const Tracer& tracer, const Sobol& sobol,
                 SampleScratch& scratch);

// The share of the light that passes: a ratio of the two sums, so that the weights need be known up to a
// factor only, with its standard error from the spread of blocks. The blocks complement each other, so that
// the error is rather less.
struct Share {
  double value, error;
};
Share find_share(const PairSums& sums);

}  // namespace patchlight
