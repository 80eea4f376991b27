// What a user may ask of the solver. One struct; each line says what a larger value does.
#pragma once

#include <cstdint>

namespace patchlight {

struct SolverSettings {
  uint32_t pass_count_max = 16;  // more passes: more bounces of light
  double until = 0.001;          // larger stops earlier: share of pass 1's largest added radiosity; 0: never
  float patch_size = 0;      // longest edge of a starting patch, lengths; larger starts coarser; 0: automatic
  float patch_size_min = 0;  // a patch whose longest edge is below this is not split; 0: automatic
  float threshold = 0.1f;    // neighbours that differ by a larger share of the larger one are split
  uint64_t patch_count_max = 200000;  // the budget of patches (elements)
  uint32_t rays = 256;                // rays a row; more: less noise, more time
  uint64_t seed = 1;                  // another seed, other samples
  bool keep_rows = true;              // false: form factors are computed again in every pass; same bits
};

}  // namespace patchlight
