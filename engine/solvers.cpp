// The table of solvers.
#include "solvers.h"

#include "forecast.h"
#include "solution.h"

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
    {"passes", "pass", "bounce by bounce: after pass k, all light of up to k reflections", advance,
     is_converged, forecast_no_bytes, forecast_no_seconds, kAnyCount},
    {"shooting", "shot", "progressive refinement: the brightest patch sends its light first", advance_shot,
     is_shot, forecast_no_bytes, forecast_shooting_seconds, kShootingPatches},
    {"matrix", "solution", "all form factors, then the whole linear system at once", solve_matrix, is_solved,
     forecast_matrix_bytes, forecast_matrix_seconds, kMatrixPatches},
};

}  // namespace

std::span<const Solver> solvers() { return kSolvers; }

}  // namespace patchlight
