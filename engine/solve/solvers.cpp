// The table of solvers.
#include "engine/solve/solvers.h"

#include "engine/solve/forecast.h"
#include "engine/solve/solve_matrix.h"
#include "engine/solve/solve_shooting.h"

namespace patchlight {
namespace {

uint64_t forecast_no_bytes(const FaceTable&, const SolverSettings&, uint64_t) { return 0; }
double forecast_no_seconds(const FaceTable&, const SolverSettings&, uint64_t) { return 0; }

constexpr uint64_t kAnyCount = ~uint64_t{0};
// The matrix of so many elements takes seconds and some hundred megabytes.
constexpr uint64_t kMatrixPatches = 3000;
// Shots reach all elements, and there are a few for each patch.
constexpr uint64_t kShootingPatches = 6000;

constexpr Solver kSolvers[] = {
    {.name = "passes",
     .step = "pass",
     .summary = "bounce by bounce: after pass k, all light of up to k reflections",
     .advance = advance,
     .is_converged = is_converged,
     .forecast_bytes = forecast_no_bytes,
     .forecast_seconds = forecast_no_seconds,
     .patch_count_usual = kAnyCount,
     .goes_by_bounces = true,
     .takes_one_step = false,
     .chooses_steps = false,
     .leaves_unshot = false,
     .digits = 2},
    {.name = "shooting",
     .step = "shot",
     .summary = "progressive refinement: the brightest patch sends its light first",
     .advance = advance_shot,
     .is_converged = is_shot,
     .forecast_bytes = forecast_no_bytes,
     .forecast_seconds = forecast_shooting_seconds,
     .patch_count_usual = kShootingPatches,
     .goes_by_bounces = false,
     .takes_one_step = false,
     .chooses_steps = true,
     .leaves_unshot = true,
     .digits = 6},
    {.name = "matrix",
     .step = "solution",
     .summary = "all form factors, then the whole linear system at once",
     .advance = solve_matrix,
     .is_converged = is_solved,
     .forecast_bytes = forecast_matrix_bytes,
     .forecast_seconds = forecast_matrix_seconds,
     .patch_count_usual = kMatrixPatches,
     .goes_by_bounces = false,
     .takes_one_step = true,
     .chooses_steps = false,
     .leaves_unshot = false,
     .digits = 2},
};

}  // namespace

std::span<const Solver> solvers() { return kSolvers; }

}  // namespace patchlight
