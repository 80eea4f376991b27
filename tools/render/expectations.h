// What a scene expects beside what a solution shows.
#pragma once

#include "dsl/scene/scene.h"
#include "engine/solve/solve.h"

#include <string>

namespace patchlight {

// Mean radiosity over the exposed area of the polygons that an expectation names, W/m2, as the solution
// stands.
DRgb find_mean_radiosity(const Solution& solution, const Scene& scene, const Expectation& expectation);

// Does no channel differ by more than the tolerance's share of the largest channel?
bool is_met(const Expectation& expectation, const DRgb& found);

// "hall.floor, pass 16: expected [1.2, 1.1, 0.9] within 2 %, found [1.21, 1.1, 0.9], off by 0.8 %".
std::string describe_result(const Expectation& expectation, const DRgb& found);

}  // namespace patchlight
