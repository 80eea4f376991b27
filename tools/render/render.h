// The verb render: a scene -> pictures after the asked passes, tables, and a report.
#pragma once

#include "tools/base/options.h"
#include "tools/base/talk.h"

#include <string>

namespace patchlight {

struct RenderOptions {
  std::string report;  // a file; empty: beside the pictures
  bool require_convergence = false;
};

// Returns the exit code: 0, 6 where convergence is required and was not reached, or 128 + the signal that
// stopped the run. Throws UserError.
int render(const Options& options, Talk& talk);

}  // namespace patchlight
