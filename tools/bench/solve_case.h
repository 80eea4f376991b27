// Whole solves for the benchmark, and the clocks around them.
#pragma once

#include "dsl/scene/scene.h"
#include "engine/solve/solve.h"

#include <optional>
#include <string>

namespace patchlight {

struct Times {
  double wall = 0, processor = 0;  // of all threads
};
Times read_clocks();
Times operator-(Times end, Times begin);

// Warnings are not repeated: the verb has said them.
Scene load_quietly(const std::string& path);

// The scene's own settings with a budget of at most `max_patches`. Throws UserError (too-many-patches).
SolverSettings settings_within(const Scene& scene, uint64_t max_patches);

// From starting patches to the last pass.
Solution solve_whole(std::shared_ptr<const Surfaces> surfaces, const SolverSettings& settings);

// Settings for a mesh of at most `count` patches and not many fewer: half of them from the start, least sizes
// in proportion. None where the scene has too many faces for that.
std::optional<SolverSettings> settings_for_count(const FaceTable& faces, SolverSettings settings,
                                                 uint64_t count);

// Largest relative error of a solution whose answer is known: a furnace (closed, and all faces alike: after
// pass k, E times the sum of rho^m over m = 0..k), or what the scene expects after this pass. None otherwise.
std::optional<double> find_known_error(const Solution& solution, const Scene& scene);

}  // namespace patchlight
