// The list `include`: other files whose variables, materials and objects belong to the scene.
#pragma once

#include "dsl/language/values.h"

#include <string>
#include <vector>

namespace patchlight {

// One file of a scene: its map of scene keys, and what its names begin with ("" or "lamps.").
struct SceneFile {
  std::string prefix;
  MapValues map;
};

// Reads the map at `root` of the scene file `path`, and all files that it includes, directly or not, into
// `tree` (which is context.tree). Returns them with every file behind those that it includes; the scene
// itself is last. A file that is included twice under one name is read once. Errors: include-not-found,
// include-outside-root, include-cycle, too-many-includes, bad-unit, and those of each file.
std::vector<SceneFile> read_includes(const Context& context, Tree& tree, uint32_t root,
                                     const std::string& path);

}  // namespace patchlight
