// The solver `shooting`, shot by shot.
#pragma once

#include "engine/solve/solve.h"

namespace patchlight {

// One shot: the patch with the most unshot power sends it to all elements; where there is a sky, the first
// shot is its light. Freezes the mesh if that was not done. Unshot columns hold what was received and not
// sent on.
const PassReport& advance_shot(Solution& solution);

// True once less than the share `until` of what all shots brought is left unshot.
bool is_shot(const Solution& solution);

}  // namespace patchlight
