// What a user may ask of the solver. One struct; each line says what a larger value does.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace patchlight {

struct SolverSettings {
  uint32_t pass_count_max = 16;  // more passes: more bounces of light
  double until = 0.001;          // larger stops earlier: share of pass 1's largest added radiosity; 0: never
  float patch_size = 0;      // longest edge of a starting patch, lengths; larger starts coarser; 0: automatic
  float patch_size_min = 0;  // a patch whose longest edge is below this is not split; 0: automatic
  float threshold = 0.1f;    // neighbours that differ by a larger share of the larger one are split
  float threshold_indirect = 0;  // the same of the patches that carry light between surfaces; 0: automatic
  uint64_t patch_count_max = 200000;  // the budget of patches (elements)
  uint32_t rays = 144;                // rays a row; more: less noise, more time
  float quality = 1;    // times the rays and finer patches at once: about so many times the time; less error
  double error = 0.01;  // asked for, mean over mean: a smaller one takes more rays where noise is largest
  uint64_t seed = 1;    // another seed, other samples
  bool keep_rows = true;  // false: form factors are computed again in every pass; same bits
};

// So many times the usual work: errors fall about as its square root does.
inline double find_effort(const SolverSettings& settings) {
  const double usual_over_asked = SolverSettings{}.error / settings.error;
  return std::clamp(settings.quality * usual_over_asked * usual_over_asked, 0.01, 100.0);
}
// Rays a row, with the effort counted in: two thirds of the extra time go into rays ...
inline uint32_t count_row_rays(const SolverSettings& settings) {
  const double rays = settings.rays * std::pow(find_effort(settings), 2 / 3.0);
  return static_cast<uint32_t>(std::max(std::lround(rays), 1l));
}
// ... and one third into smaller patches: what automatic lengths of patches are multiplied with.
inline float find_size_factor(const SolverSettings& settings) {
  return static_cast<float>(std::pow(find_effort(settings), -1 / 6.0));
}

}  // namespace patchlight
