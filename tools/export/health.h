// A solution to signs of its health: sums of rows, reciprocity, cracks that light leaves through.
#pragma once

#include "dsl/report/diagnostics.h"
#include "dsl/scene/scene.h"
#include "engine/solve/leaks.h"

#include <vector>

namespace patchlight {

// What rows of form factors sum to, a polygon each: the share of its row rays that hit anything, weighted by
// the patches' areas. 1 in a closed scene; less where light leaves, or leaks. -1: the polygon has no rays.
std::vector<double> find_row_sums(const Solution& solution, const FaceTable& faces, size_t polygon_count);

// How far the rows of two polygons disagree on what passes between them, a polygon each: the largest
// |A_i F_ij - A_j F_ji| over the smaller of the two areas. It tells the noise of the rows: exact ones would
// give 0. Empty where rows are not kept, or polygons are more than kReciprocityMax.
std::vector<double> find_reciprocity_errors(const Solution& solution, const FaceTable& faces,
                                            size_t polygon_count);
constexpr size_t kReciprocityMax = 2000;

struct Health {
  std::vector<double> row_sums, reciprocity_errors;  // a row a polygon
  LeakReport leaks;
};
Health find_health(const Scene& scene, const Solution& solution);

// A warning (light-leak) where a scene that looks closed loses more than a hundredth of its light through
// cracks, with the edge that most of it passes; its severity is kWarning. Empty where there is none.
std::vector<Diagnostic> describe_leaks(const Scene& scene, const LeakReport& leaks);

}  // namespace patchlight
