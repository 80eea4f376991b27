// A finished run -> S-convergence.svg and S-rounds.svg: drawings of how it went.
#include "tools/export/exporters.h"
#include "tools/image/plots.h"

namespace patchlight {
namespace {

PlotText describe_run(const FinishedRun& run) {
  return {.title = run.scene.title.empty() ? std::string(run.stem) : run.scene.title,
          .step = run.report.solver.step,
          .metres_per_length = run.scene.metres_per_length(),
          .until = run.scene.solver.until};
}

}  // namespace

void export_convergence(NewFile& file, const FinishedRun& run) {
  append_file(file, plot_convergence(run.solution.log.passes, describe_run(run)));
}

void export_rounds(NewFile& file, const FinishedRun& run) {
  append_file(file, plot_rounds(run.solution.log.rounds, describe_run(run)));
}

}  // namespace patchlight
