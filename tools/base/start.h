// What every verb that solves does first.
#pragma once

#include "tools/base/options.h"
#include "tools/base/talk.h"

namespace patchlight {

// Starts the threads that are asked for; says so where the system grants fewer. Returns their number.
size_t start_threads(const Options& options, Talk& talk);

}  // namespace patchlight
