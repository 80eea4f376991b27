// What the tests of damaged scenes share: the scenes, and what becomes of a text.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace patchlight::testing {

struct SceneText {
  std::string path, text;
};

// Shipped scenes that have every construct among them, and those of tests/schema/right, which hold every key
// of the language.
std::vector<SceneText> list_scenes();

// Counts of the ways in which texts ended: 0, 2, 3, 4 or 5.
using ExitCounts = std::map<int, size_t>;

// Does to a text what `patchlight check` does, up to the limits, in this process, as the file at `path`.
// Fails the test for an exception that is no UserError, a message that lacks something or prints raw text, a
// number that is not finite in what was loaded.
void check_text(const SceneText& scene, const std::string& text, ExitCounts& counts);

}  // namespace patchlight::testing
