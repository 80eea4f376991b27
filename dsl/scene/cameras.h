// The cameras of a scene.
#pragma once

#include "dsl/language/language.h"
#include "dsl/language/number.h"
#include "dsl/scene/scene.h"

#include <vector>

namespace patchlight {

// The keys of a camera.
const KeyTable& camera_keys();

// Each reads one map, or the list `cameras`, into rows. Lengths stay in file units: the caller converts them
// once the engine's unit is known. Errors are those of read_map, degenerate-camera, image-too-large,
// duplicate-id, and missing-key for a name where there are several.
void read_camera(const Context& context, uint32_t node, std::vector<Camera>& cameras);
void read_cameras(const Context& context, uint32_t list, std::vector<Camera>& cameras);

}  // namespace patchlight
