// Solver and output: the maps of a scene that are neither geometry nor cameras.
#pragma once

#include "dsl/language/number.h"
#include "dsl/scene/scene.h"

namespace patchlight {

// Each reads one map into the scene's struct. Lengths stay in file units: the caller converts them once the
// engine's unit is known. Errors are those of read_map, and for output snapshot-beyond-passes and
// output-outside-dir.
void read_solver(const Context& context, uint32_t node, SolverSettings& solver);
void read_output(const Context& context, uint32_t node, const SolverSettings& solver, OutputSettings& output);

}  // namespace patchlight
