// The threads that a run was asked for, and those that it gets.
#pragma once

#include "options.h"
#include "talk.h"

namespace patchlight {

// Sets them for all later loops, all cores unless asked otherwise; says so where the system grants fewer.
// Returns how many there are.
size_t start_threads(const Options& options, Talk& talk);

}  // namespace patchlight
