// Values of the command line put into the tree of a scene.
#pragma once

#include "dsl/yaml/tree.h"

#include <string>
#include <vector>

namespace patchlight {

// Applies each "path=value" to the tree below `root`, before anything is read from it: the value, any YAML,
// replaces that of the path or is added to its map. A path names keys and, in lists, numbers from 0 or ids:
// solver.passes, materials.white.reflectance, objects.lamp.quad.size. Errors: usage, and those of the value's
// YAML, placed in a file of the name "--set path".
void apply_overrides(Messages& messages, const std::vector<std::string>& overrides, uint32_t root,
                     Tree& tree);

}  // namespace patchlight
