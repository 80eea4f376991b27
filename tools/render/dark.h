// What is legal and dark, once a run is over: said as warnings.
#pragma once

#include "dsl/scene/scene.h"
#include "tools/base/talk.h"
#include "tools/render/run.h"

namespace patchlight {

// Warns of a scene in which nothing is lit (nothing-lit), of lamps whose light reaches nothing (lost-lamp),
// and of cameras that have no surface in view (empty-view).
void warn_of_dark(const Task& task, const PictureState& pictures, const Solution& solution, Talk& talk);

}  // namespace patchlight
