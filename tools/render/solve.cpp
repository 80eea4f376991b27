// Rounds until nothing splits, steps until nothing changes.
#include "tools/render/solve.h"

#include "tools/base/format.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

void say_step(const Solution& solution, const Plan& plan, const PassReport& step, uint32_t step_last,
              Talk& talk) {
  const Solver& solver = *plan.solver;
  // Nobody knows how many shots there will be; what they leave unshot says how far they are.
  if (plan.snapshots.back() == kLastStep)
    say_progress(talk, fmt::format("{} {}, unshot {:.2g} of {:.2g}", solver.step, step.pass,
                                   sum_channels(step.unshot_power),
                                   solution.shooting ? solution.shooting->power : 0.0));
  else
    say_progress(talk, fmt::format("{} {} of {}", solver.step, step.pass, step_last));
}

}  // namespace

void solve_mesh(Solution& solution, const Scene& scene, Talk& talk,
                const std::function<void()>& after_round) {
  solution = make_solution(make_surfaces(scene.faces, scene.sky), scene.solver);
  do {
    if (after_round) after_round();
    say_progress(talk, fmt::format("refining: {} patches", format_count(solution.mesh.elements.size())));
  } while (refine(solution));
  freeze(solution);
}

void take_steps(Solution& solution, const Plan& plan, uint32_t step_last, Talk& talk,
                const std::function<void(const StepEnd&)>& after_step) {
  const Solver& solver = *plan.solver;
  for (bool last = false; !last;) {
    const PassReport& step = solver.advance(solution);
    const bool converged = solver.is_converged(solution);
    last = converged || step.pass >= step_last;
    say_step(solution, plan, step, step_last, talk);
    if (after_step) after_step({step, converged, last});
  }
}

}  // namespace patchlight
