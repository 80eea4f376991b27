// The ways to solve a frozen mesh: one row a solver, one pair of files solve_<name> a row.
#pragma once

#include "engine/solve/solve.h"

#include <span>
#include <string_view>

namespace patchlight {

struct Solver {
  std::string_view name;
  std::string_view step;     // what one call of advance is: pass, shot or solution
  std::string_view summary;  // for people
  const PassReport& (*advance)(Solution&);
  bool (*is_converged)(const Solution&);
  // Bytes beside those of the mesh and its rows, an upper estimate; arguments as forecast_bytes().
  uint64_t (*forecast_bytes)(const FaceTable&, const SolverSettings&, uint64_t starting_patches);
  // Seconds of one core beside those of the mesh and of the passes.
  double (*forecast_seconds)(const FaceTable&, const SolverSettings&, uint64_t starting_patches);
  uint64_t patch_count_usual;  // its budget of patches where nobody asks for more
  bool goes_by_bounces;        // after step k all light of up to k reflections is there
  bool takes_one_step;         // that is the whole solution
  bool chooses_steps;          // pictures after any steps are worth asking for: there are thousands
  bool leaves_unshot;          // find_ambient() has something to guess
  uint32_t digits;             // of a step's number in names of files
};

// The default first.
std::span<const Solver> solvers();

}  // namespace patchlight
