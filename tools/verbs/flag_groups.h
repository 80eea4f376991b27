// Flags that several verbs have: each function adds a group of them, with what must hold of its flags
// together.
#pragma once

#include "tools/base/options.h"
#include "tools/base/usage.h"

namespace patchlight {

// The scene, and what changes it before it is read.
void add_scene(Usage& usage, Options& options);
// How the program speaks.
void add_talk_flags(Usage& usage, Options& options);
// Flags of all that casts rays.
void add_run_flags(Usage& usage, Options& options);
// Flags that change what a solve takes; those of all that casts rays are among them.
void add_solver_flags(Usage& usage, Options& options);
// Flags that choose another way to the light.
void add_method_flags(Usage& usage, Options& options);
// Flags that change which pictures there are.
void add_picture_flags(Usage& usage, Options& options);
void add_out_flag(Usage& usage, Options& options);
// How bright pictures are.
void add_exposure_flag(Usage& usage, Options& options);
void add_tone_flag(Usage& usage, Options& options);
// Flags that change how pictures look.
void add_look_flags(Usage& usage, Options& options);
// What render, check and show have in common.
void add_common_flags(Usage& usage, Options& options);

}  // namespace patchlight
