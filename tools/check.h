// The verb check: a scene -> its mistakes, its size and what a run would take.
#pragma once

#include "options.h"
#include "talk.h"

namespace patchlight {

// Returns 0 for a scene that can be rendered. Throws UserError for one that cannot.
int check(const Options& options, Talk& talk);

}  // namespace patchlight
