// Text to scene: the door of this folder.
#pragma once

#include "dsl/report/diagnostics.h"
#include "dsl/report/limits.h"
#include "dsl/scene/scene.h"

#include <string>
#include <vector>

namespace patchlight {

// What the command line changes in a scene, in the order in which it was given, and what it may cost.
struct LoadOptions {
  std::vector<std::string> definitions;  // "w=8": the value of a variable (-D)
  std::vector<std::string> overrides;    // "solver.passes=4": any value of the file, or a new one (--set)
  Limits limits = {};
  bool fine_corners = false;  // corners are kept in double precision, too: Scene::fine_corners
};

// Reads, checks and compiles one scene file, with its includes; `-` reads standard input. Warnings are
// appended in the order of the file. Throws UserError with every mistake that could be found in one go.
Scene load_scene(const std::string& path, std::vector<Diagnostic>& warnings, const LoadOptions& options = {});

// The same for text that is already in memory; `name` stands for the file in messages and for its includes'
// folder.
Scene load_scene_text(std::string_view text, const std::string& name, std::vector<Diagnostic>& warnings,
                      const LoadOptions& options = {});

}  // namespace patchlight
