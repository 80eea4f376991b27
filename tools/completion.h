// Verbs and flags to a script that makes a shell complete them.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace patchlight {

struct FlagWords {
  std::vector<std::string> names;  // -o, --passes
  std::string value;  // what its value is called: FILE, DIR, a|b|c, a|b|c,...; empty: it takes none
  std::string help;
};

struct VerbWords {
  std::string name, help;
  std::string argument;  // SCENE, SHELL; empty: none
  std::vector<FlagWords> flags;
};

enum class Shell { kBash, kZsh };

// The script. Files are offered for FILE and SCENE, folders for DIR, the words for a|b|c, nothing else.
std::string format_completion(Shell shell, std::span<const VerbWords> verbs);

}  // namespace patchlight
