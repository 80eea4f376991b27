// A solved scene to the lamps whose light comes to nothing.
#pragma once

#include "engine/solve/solve.h"

#include <vector>

namespace patchlight {

// Which polygons some of whose light reaches a lit side, as far as the rays of the solution tell: a row a
// polygon. Those that emit nothing count as if they did not.
std::vector<uint8_t> find_reaching(const Solution& solution);

}  // namespace patchlight
