// Verbs and flags to a script that makes a shell complete them.
#pragma once

#include "tools/base/usage.h"

#include <span>
#include <string>
#include <vector>

namespace patchlight {

struct VerbWords {
  std::string name, help;
  Usage usage;
};

// All verbs, as the command line knows them.
std::vector<VerbWords> list_words();

enum class Shell { kBash, kZsh };

// The script. Files are offered for FILE and SCENE, folders for DIR, the words for a|b|c, nothing else.
std::string format_completion(Shell shell, std::span<const VerbWords> verbs);

}  // namespace patchlight
