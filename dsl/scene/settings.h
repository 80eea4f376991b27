// Cameras, solver and output: the maps of a scene that are not geometry.
#pragma once

#include "dsl/language/number.h"
#include "dsl/scene/scene.h"

#include <vector>

namespace patchlight {

// Each reads one map (or the list `cameras`) into the scene's struct. Lengths stay in file units: the caller
// converts them once the engine's unit is known. Errors are those of read_map and, for cameras,
// degenerate-camera, image-too-large, duplicate-id, missing-key (a name, where there are several); for output
// snapshot-beyond-passes and output-outside-dir.
void read_camera(const Context& context, uint32_t node, std::vector<Camera>& cameras);
void read_cameras(const Context& context, uint32_t list, std::vector<Camera>& cameras);
void read_solver(const Context& context, uint32_t node, SolverSettings& solver);
void read_output(const Context& context, uint32_t node, const SolverSettings& solver, OutputSettings& output);

}  // namespace patchlight
