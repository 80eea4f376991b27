// How far the passes' light may be off, by what they know of it themselves.
#pragma once

#include "engine/film/film.h"
#include "engine/solve/solve.h"

#include <span>

namespace patchlight {

// Mean absolute errors over the mean of the light that surfaces send on: what a comparison with the truth
// would find. Emission is exact and does not count.
struct ErrorParts {
  double noise_direct = 0;  // emitters that are seen in part, by rays
  double noise_rows = 0;    // light of surfaces, by rows of rays, with what smoothing them changes
  double mesh = 0;          // a surface of values through the patches' means cannot follow the light
  double passes = 0;        // what further passes would add
  double estimate() const;  // of all together, as errors that have nothing to do with each other
};

struct ErrorTable {
  ErrorParts surfaces;               // over the exposed area of all surfaces
  ErrorParts shown;                  // over all pictures; that of the surfaces where there is none
  std::vector<ErrorParts> polygon;   // a row a polygon, shares of the scene's mean
  std::vector<double> polygon_area;  // a row a polygon, exposed, lengths squared
};

// After the last pass of the solver `passes`; all 0 before the first. films: smooth ones. Not seen: what no
// ray found, and what patches that share a row have different.
ErrorTable find_error(const Solution& solution, std::span<const FilmTable> films);

}  // namespace patchlight
