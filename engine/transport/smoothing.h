// Less noise in what rows carry: as much smoothing as two halves of their rays say is right, and no more.
#pragma once

#include "engine/mesh/surfaces.h"

#include <span>

namespace patchlight {

// Which leaves are smoothed, and beside which: CSR, entry -> neighbours with weights that sum to 1. A surface
// of constant slope stays as it is: a leaf has weights along the directions alone in which it has neighbours
// on both sides, and nearer ones weigh more.
struct SmoothingTable {
  std::vector<uint32_t> leaf;  // a row an entry
  std::vector<uint32_t> first;
  std::vector<uint32_t> neighbour;
  std::vector<float> weight;
  size_t size() const { return leaf.size(); }
};
// Of the leaves `which`, ascending; those without such neighbours get no entry.
SmoothingTable make_smoothing(const PatchTable& leaves, const Surfaces& surfaces,
                              std::span<const uint32_t> which);

// Values of leaves, W/m2, and what is known of their error. `noise` is one sample of it: half the difference
// of the values that two independent halves of the rays give, its channels' mean.
struct NoisyColumns {
  std::span<Rgb> value;
  std::span<float> noise;
  std::span<float> error;  // overwritten: what is left, root mean square over a neighbourhood
};

// Smooths each leaf's value over as many neighbours as leave the least error: noise that is left, and what
// smoothing changes of the light itself. Both are measured, the second as the change of the values beyond the
// change of their noise (an unbiased estimate of the risk: Stein: Estimation of the Mean of a Multivariate
// Normal Distribution, 1981; from two halves of the samples: Rousselle, Knaus, Zwicker: Adaptive Rendering
// with Non-Local Means Filtering, 2012), and averaged over a neighbourhood. So an edge of the light keeps its
// noise and stays sharp. `noise` becomes that of the smoothed values. strengths: choices, 0, 1, 2, 4, ...
// steps of half a leaf's width: more take longer.
void smooth_noise(const NoisyColumns& columns, const SmoothingTable& smoothing, uint32_t strengths);

// Scales those values of `after` that were smoothed, polygon by polygon, so that their sum over the exposed
// area is again that of `before`: smoothing neither makes light nor takes it away. Both a row a leaf, W/m2.
void keep_power(std::span<Rgb> after, std::span<const Rgb> before, const SmoothingTable& smoothing,
                const PatchTable& leaves, const FaceTable& faces);

}  // namespace patchlight
