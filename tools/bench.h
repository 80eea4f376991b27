// The verb bench: how fast this build is on this machine, and against what.
#pragma once

#include "options.h"
#include "talk.h"

namespace patchlight {

// Returns the exit code: 0, 70 where threads changed a solution, 128 + the signal that stopped it. Throws
// UserError.
int bench(const Options& options, Talk& talk);

}  // namespace patchlight
