// The sky and the sun of a scene.
#pragma once

#include "dsl/language/values.h"
#include "dsl/scene/scene.h"

namespace patchlight {

// Reads the maps `sky` and `sun` of a scene into scene.sky. Errors are those of read_map, and ambiguous-sky,
// missing-key and out-of-range for keys that do not go together; zero-axis. Warns (sun-below-horizon) of a
// sun that shines from below.
void read_sky(const Context& context, const MapValues& scene_keys, Scene& scene);

}  // namespace patchlight
