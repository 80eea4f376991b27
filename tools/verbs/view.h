// The verb view: a scene -> what a patch sees.
#pragma once

#include "dsl/scene/scene.h"
#include "tools/base/options.h"
#include "tools/base/talk.h"

namespace patchlight {

// What a patch sees: from where, and when.
struct ViewOptions {
  std::string polygon;
  double u = 0.5, v = 0.5;
  bool pass_asked = false;
  uint32_t pass = 0;    // 0: emission alone; the last one unless asked
  uint32_t size = 720;  // pixels, either way
  bool label = false;
};

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
