// What elements send to the bright places that a pass aims at.
#pragma once

#include "engine/mesh/surfaces.h"

#include <span>

namespace patchlight {

// Bright places to aim at: nodes of the element trees that send more than three times the scene's mean, about
// `count` of them, always the node of most flux split first.
SourceTable make_sources(const PatchTable& elements, const Surfaces& surfaces, std::span<const Rgb> sent,
                         uint32_t count);

}  // namespace patchlight
