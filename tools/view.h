// The verb view: a scene -> what a patch sees.
#pragma once

#include "dsl/scene.h"
#include "options.h"
#include "talk.h"

namespace patchlight {

// Returns the exit code: 0, or 128 + the signal that stopped the run. Throws UserError; usage for a polygon
// that the scene does not have and for u,v outside of it.
int view(const Options& asked, Talk& talk);

// A place on a polygon and the side from which it is lit.
struct PatchPlace {
  Vec3 point, normal;  // lengths, unit
};
// u and v run from 0 to 1 along the polygon's first edge and across, in the rectangle around it.
PatchPlace find_patch_place(const Scene& scene, const ViewOptions& view);

}  // namespace patchlight
