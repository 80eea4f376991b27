// Text to scene: the door of this folder.
#pragma once

#include "diagnostics.h"
#include "scene.h"

#include <string>
#include <vector>

namespace patchlight {

// Reads, checks and compiles one scene file; `-` reads standard input. Warnings are appended in the order of
// the file. Throws UserError with every mistake that could be found in one go.
Scene load_scene(const std::string& path, std::vector<Diagnostic>& warnings);

// The same for text that is already in memory; `name` stands for the file in messages.
Scene load_scene_text(std::string_view text, const std::string& name, std::vector<Diagnostic>& warnings);

}  // namespace patchlight
