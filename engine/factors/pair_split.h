// A pair of surfaces with something between them, cut into pairs of parts: what is certain is taken out, and
// what remains is left to rays.
#pragma once

#include "engine/factors/contour.h"
#include "engine/factors/shaft.h"

namespace patchlight {

// A part of each of the two, convex, with its corners in SplitPair::corners.
struct SubPair {
  double exchange;  // with nothing between, lengths squared
  uint32_t first_a, count_a, first_b, count_b;
  uint32_t blocker;  // a face whose plane cuts one end and leaves the other whole, or kNone
  uint8_t cuts_a;    // 1: it cuts a
};

struct SplitPair {
  double clear = 0;                // exchange of the parts between which nothing can be
  double mixed = 0;                // of the parts in doubt, with nothing between
  std::vector<SubPair> sub_pairs;  // in doubt
  std::vector<DVec3> corners;
};

// Samples that rays would take to find the exchange of parts in doubt with this standard error, about; both
// in lengths squared. Measured with screens, boxes and grilles.
inline double forecast_samples(double mixed, double error) { return std::pow(mixed / error, 1.6); }

// Parts are split, those with the largest exchange first, for as long as this is cheaper than the rays that
// it saves; `exchange`: that of the pair with nothing between, `error`: the standard error that rays will
// have to reach, both in lengths squared. Each integral errs by `tolerance`, lengths squared. Memory of
// `split` is reused.
void split_pair(SplitPair& split, const Bvh& tree, const FaceTable& faces, const PartTable& parts,
                uint32_t part_a, uint32_t part_b, double exchange, double error, double tolerance,
                ContourScratch& scratch);

inline std::span<const DVec3> corners_a(const SplitPair& split, const SubPair& pair) {
  return std::span(split.corners).subspan(pair.first_a, pair.count_a);
}
inline std::span<const DVec3> corners_b(const SplitPair& split, const SubPair& pair) {
  return std::span(split.corners).subspan(pair.first_b, pair.count_b);
}

}  // namespace patchlight
