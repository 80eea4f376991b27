// The verb verify: a scene -> is its light as it expects?
#pragma once

#include "options.h"
#include "talk.h"

namespace patchlight {

// Returns the exit code: 0, 1 where the light differs from what the scene expects, or 128 + the signal that
// stopped the run. Throws UserError; missing-key for a scene that expects nothing.
int verify(const Options& options, Talk& talk);

}  // namespace patchlight
