// Pictures of a whole run: the storyboard of its snapshots, animations of its passes and of its rounds.
#pragma once

#include "run.h"

namespace patchlight {

// After every round of refinement: the mesh on the coarse solution, for S-rounds.gif.
void take_round(Run& run);

// After every pass: its picture, for S-passes.gif.
void take_pass(Run& run);

// After the passes or shots that are to be pictured: radiosity at the values of the films, for
// S-storyboard.png and S-shots.gif, and the same as a display shows it.
void take_snapshot(Run& run, const std::vector<Rgb>& radiosity, std::span<const Rgb> shown);

// Sends what was taken to its files.
void write_series(Run& run);

// S-convergence.svg and S-rounds.svg, where they are asked for.
void write_plots(Run& run);

}  // namespace patchlight
