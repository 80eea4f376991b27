// Which emitters polygons leave to their rows, and which they aim at.
#pragma once

#include "engine/light/emitters.h"
#include "engine/mesh/surfaces.h"

#include <vector>

namespace patchlight {

// Where emitters fill most of a polygon's sky its rows see them better than rays that aim at each. A row a
// polygon: its rows see what emits up to this (W/m2, luminance), and it aims at what is brighter, such as a
// sun before a dome; 0: it aims at all. One answer for all polygons whose patches share receivers.
std::vector<float> find_emission_by_rows(const Surfaces& surfaces, const EmitterGroups& groups,
                                         const PatchTable& patches, const ReceiverTable& receivers);

}  // namespace patchlight
