// Runs the built program as users do, in a process of its own.
#pragma once

#include "tests/folder.h"

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace patchlight::testing {

struct ChildSettings {
  std::string input;        // its standard input
  std::string output = "";  // a file for its standard output; empty: captured
  bool output_closed = false;
  std::optional<uint64_t> file_bytes_max;                        // as ulimit -f
  std::optional<uint64_t> address_bytes_max;                     // as ulimit -v
  std::vector<std::pair<std::string, std::string>> environment;  // added to the test's own
};

struct ChildResult {
  int exit_code = -1;  // 128 + signal where a signal ended it
  std::string out, err;
};

// A program that may still be running. Its streams are files in `folder`.
struct Child {
  Folder folder;
  pid_t process = -1;
};

void start_child(Child& child, const std::vector<std::string>& arguments, const ChildSettings& settings = {});
ChildResult finish_child(Child& child);
// Both.
ChildResult run_child(const std::vector<std::string>& arguments, const ChildSettings& settings = {});

// A floor below a lamp; and flags that make a run of it short.
extern const char* const kBoxScene;
extern const std::vector<std::string> kShortRun;

// render, the scene's path, -o and `out`, kShortRun, then `more`.
std::vector<std::string> render_words(const std::string& scene, const std::string& out,
                                      const std::vector<std::string>& more = {});

// True for a whole PNG file: signature first, IEND chunk last.
bool is_whole_png(const std::string& bytes);

}  // namespace patchlight::testing
