// Pictures of a whole run: the storyboard of its snapshots, animations of its passes and of its rounds.
#pragma once

#include "tools/render/run.h"

#include <span>
#include <string>
#include <vector>

namespace patchlight {

// After every round of refinement: the mesh on the coarse solution, for S-rounds.gif.
void take_round(Series& series, const Task& task, const Solution& solution);

// Before pass 1: the storyboard tells of what comes after it.
void start_storyboard(Series& series, const Task& task, const Solution& solution);

// After every pass: its picture, for S-passes.gif.
void take_pass(Series& series, const Task& task, const PictureState& pictures, const Solution& solution,
               bool converged);

// After the passes or shots that are to be pictured: radiosity at the values of the films, for
// S-storyboard.png and S-shots.gif, and the same as a display shows it.
struct Snapshot {
  std::vector<Rgb> radiosity, shown;
  bool converged = false;
};
void take_snapshot(Series& series, const Task& task, const PictureState& pictures, const Solution& solution,
                   const Snapshot& snapshot);

// Sends what was taken to its files.
void write_series(OutputFiles& files, Series& series, const Task& task, const PictureState& pictures,
                  const Solution& solution);

}  // namespace patchlight
