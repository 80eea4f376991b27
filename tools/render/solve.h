// The solve as every verb goes through it: rounds, then steps, with a line of progress each.
#pragma once

#include "engine/solve/solve.h"
#include "tools/base/talk.h"
#include "tools/render/plan.h"

#include <functional>

namespace patchlight {

// A solution with its final mesh. `after_round` is called with the solution after every round of refinement.
// `solution` is written under way, so that what is there is not lost where the run is stopped.
void solve_mesh(Solution& solution, const Scene& scene, Talk& talk,
                const std::function<void()>& after_round = {});

struct StepEnd {
  const PassReport& step;
  bool converged = false;
  bool last = false;  // converged, or as many steps as were asked for
};
// Steps of the plan's solver, at least one: `step_last` of them, or fewer where it has converged before.
void take_steps(Solution& solution, const Plan& plan, uint32_t step_last, Talk& talk,
                const std::function<void(const StepEnd&)>& after_step = {});

}  // namespace patchlight
