// Two outlines to the light that passes between what they bound, nothing being in between.
#pragma once

#include "engine/factors/clip.h"

#include <span>
#include <vector>

namespace patchlight {

// Memory that is reused from call to call.
struct ContourScratch {
  struct Edge {
    DVec3 start, along;  // along: unit
    double length;
    double cosine;  // to the edge of the other outline
    bool follows;   // it starts where the row before it ends
  };
  std::vector<Edge> edges;
};

// The exchange area A_a F_ab = A_b F_ba, lengths squared, of two planar surfaces with these outlines. All of
// each must lie before the plane of the other (clip.h); they may touch. Its error is about `tolerance`,
// lengths squared, or what rounding leaves: some 1e-15 of the product of the two outlines' lengths.
//
// Lambert's formula integrated over the receiver, turned into a double integral along both outlines by
// Stokes's theorem: 2 pi A F = sum of ln r dl dl (Sparrow: A New and Simpler Formulation for Radiative Angle
// Factors, 1963). The inner integral is exact, the outer one adaptive, by Gauss and Kronrod's rules (Kronrod:
// Nodes and Weights of Quadrature Formulas, 1965). Sums of logarithms lose what is small beside what they
// sum: of outlines very far apart for their sizes the kernel itself is summed, and of an outline very much
// larger than the other all but the neighbourhood of the other is left to its factor from points.
double find_exchange_area(std::span<const Segment> a, std::span<const Segment> b, double tolerance,
                          ContourScratch& scratch);

// What rounding may leave of such a sum, lengths squared.
double find_exchange_rounding(std::span<const Segment> a, std::span<const Segment> b);

}  // namespace patchlight
