// What a run has to tell afterwards, for its files and the summary.
#pragma once

#include "engine/solve/error.h"
#include "engine/solve/solvers.h"
#include "tools/export/health.h"
#include "tools/export/object_power.h"

#include <optional>
#include <string>
#include <vector>

namespace patchlight {

// Wall seconds. Writing runs beside the solver: `write` is what the run waited for it.
struct StageSeconds {
  double load = 0, trace = 0, split = 0, solve = 0, render = 0, write = 0, total = 0;
};

// Filled while the run goes; what is empty was not measured and is left out of the report.
struct RunReport {
  Solver solver = solvers()[0];
  std::string stopped_reason;  // converged, passes or signal
  std::string stopped_signal;  // SIGINT or SIGTERM, after a signal
  size_t thread_count = 0;
  std::optional<double> exposure_ev;
  std::optional<uint64_t> solution_hash;
  std::optional<PowerLedger> power;  // W
  std::optional<ErrorTable> error;
  Health health;
  ObjectPowerTable objects;  // W
  StageSeconds seconds;
  uint64_t film_rays = 0;
  uint64_t film_bytes = 0;
  uint64_t forecast_bytes = 0;
};

// The report as JSON text. `solution` may be empty tables when the run was stopped early.
std::string format_report(const RunReport& report, const Scene& scene, const Solution& solution);

// All rays of a run: rounds, passes and pictures.
uint64_t count_rays(const RunReport& report, const Solution& solution);

}  // namespace patchlight
