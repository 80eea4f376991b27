// Faces and settings to what a run will likely take: by counts, before anything is traced.
#pragma once

#include "engine/settings.h"
#include "engine/sky.h"
#include "engine/tables.h"

namespace patchlight {

// Estimates, mostly within a factor of two. Seconds are those of one core; of several cores each does its
// share. Bytes are the solver's at their largest.
struct Forecast {
  double elements = 0;  // when all rounds are done
  double patches = 0;   // that carry light between surfaces
  double rows = 0;      // of rays from them; small ones share
  double rays = 0;      // of rows and to lamps
  double seconds = 0;
  double bytes = 0;
};
Forecast forecast_solve(const FaceTable& faces, const SolverSettings& settings, uint64_t starting_patches,
                        const Sky& sky = {});

// What the solvers `matrix` and `shooting` take beside that; arguments as forecast_solve(). Very rough:
// seconds depend on what stands between the elements, and on how much they reflect.
uint64_t forecast_matrix_bytes(const FaceTable& faces, const SolverSettings& settings,
                               uint64_t starting_patches);
double forecast_matrix_seconds(const FaceTable& faces, const SolverSettings& settings,
                               uint64_t starting_patches);
double forecast_shooting_seconds(const FaceTable& faces, const SolverSettings& settings,
                                 uint64_t starting_patches);

// Bytes that a solve with these settings will hold at its peak, an upper estimate.
uint64_t forecast_bytes(const FaceTable& faces, const SolverSettings& settings, uint64_t starting_patches);

// Of one picture's film.
double forecast_film_seconds(const FaceTable& faces, double pixels);

}  // namespace patchlight
