// One shot: a patch sends its light to all elements at once.
//
// Form factors are found on the fly and forgotten (Cohen, Chen, Wallace, Greenberg: A Progressive Refinement
// Approach to Fast Radiosity Image Generation, 1988), from the receivers to the shooter (Wallace, Elmquist,
// Haines: A Ray Tracing Algorithm for Progressive Radiosity, 1989), so that small shooters are never missed.
#pragma once

#include "engine/light/visibility.h"

#include <span>

namespace patchlight {

struct ShotRays {
  uint32_t unmixed = 16, mixed = 64;  // as of DirectRays, where the shot is bright
  float bright = 0;  // irradiance, W/m2 (largest channel), below which one ray tells whether the shot arrives
};

struct ShotCounts {
  uint64_t factors = 0;  // of elements that the shooter can reach
  uint64_t rays = 0;
};

struct Shot {
  Emitter shooter;
  Rgb sent;         // W/m2
  uint64_t number;  // other samples for each shot, and for each seed
  uint64_t seed;
};

// Irradiance that each element receives from the shooter. irradiance: a row an element, W/m2, mean over its
// exposed area, overwritten.
ShotCounts shoot(std::span<Rgb> irradiance, const Shot& shot, const PatchTable& elements,
                 const Surfaces& surfaces, ShotRays rays);

}  // namespace patchlight
