// The verb show: a scene -> its merged settings, each with where it comes from.
#pragma once

#include "tools/base/options.h"
#include "tools/base/talk.h"

namespace patchlight {

struct ShowOptions {
  bool effective = false;  // the merged settings
};

// Returns the exit code 0. Throws UserError.
int show(const Options& options, Talk& talk);

// The settings of a scene with the flags put over them; make_plan has changed the scene by them already.
SettingTable merge_flags(const Scene& scene, const Options& options);

}  // namespace patchlight
