// SIGINT, SIGTERM and an end of time -> a run that stops between two rows of work and keeps what is finished.
#pragma once

#include "engine/base/parallel.h"

#include <signal.h>

namespace patchlight {

// While it lives, the first signal asks these workers to stop, and the second ends the process at once,
// without leaving temporary files. Where `seconds_max` is above 0 they are asked to stop after that time,
// too. Restores the handlers of before. One at a time.
struct StopSignals {
  struct sigaction before_int, before_term, before_alarm;
  Workers& workers;
  explicit StopSignals(Workers& stopped, double seconds_max = 0);
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();
};

// SIGINT or SIGTERM once it came, SIGALRM once time is over, else 0.
int stop_signal() noexcept;

}  // namespace patchlight
