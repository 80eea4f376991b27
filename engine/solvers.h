// The ways to solve a frozen mesh: one row a solver, one file solve_<name>.cpp a row.
#pragma once

#include "solve.h"

#include <span>
#include <string_view>

namespace patchlight {

struct Solver {
  std::string_view name;
  std::string_view step;     // what one call of advance is: pass, shot or solution
  std::string_view summary;  // for people
  const PassReport& (*advance)(Solution&, const FaceTable&, const Tracer&, const SolverSettings&);
  bool (*is_converged)(const Solution&, const SolverSettings&);
  // Bytes beside those of the mesh and its rows, an upper estimate; arguments as forecast_bytes().
  uint64_t (*forecast_bytes)(const FaceTable&, const SolverSettings&, uint64_t starting_patches);
  // Seconds of one core beside those of the mesh and of the passes.
  double (*forecast_seconds)(const FaceTable&, const SolverSettings&, uint64_t starting_patches);
  uint64_t patch_count_usual;  // its budget of patches where nobody asks for more
};

// The default first.
std::span<const Solver> solvers();

}  // namespace patchlight
