// What every verb that solves does first.
#pragma once

#include "engine/base/parallel.h"
#include "tools/base/options.h"
#include "tools/base/talk.h"

namespace patchlight {

// Threads as many as are asked for; says so where the system grants fewer.
std::shared_ptr<Workers> start_workers(const Options& options, Talk& talk);

}  // namespace patchlight
