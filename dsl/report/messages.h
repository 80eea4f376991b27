// Collects what is wrong with a scene, so that one run tells all of it.
#pragma once

#include "dsl/report/diagnostics.h"
#include "dsl/report/limits.h"

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

// A file that was read: its name as the user knows it, and its checked text. The value of a --set is one too.
struct SourceFile {
  std::string name;
  std::string text;
  bool command_line = false;
  std::string folder = {};  // canonical, for the paths that it names; empty: the scene's
};

// A place in a file. line and column are 1-based; column counts bytes (messages count characters).
struct Place {
  uint32_t file = 0;
  uint32_t line = 0;
  uint32_t column = 0;
};

// The files that were read, how much may be read, and what is to be said of it. Errors beyond kErrorsShown
// and warnings of one slug beyond kWarningsShown are only counted.
struct Messages {
  struct Count {
    std::string slug;
    size_t count = 0;
  };
  Limits limits = {};
  uint64_t scene_bytes = 0, mesh_bytes = 0;  // read so far, of the limits of these names
  std::deque<SourceFile> files;
  std::vector<Diagnostic> errors;
  size_t error_count = 0;
  std::vector<Diagnostic> warnings;
  std::vector<Count> warning_counts;
};

// Adds one error or warning at a place. The message is built from safe text already.
void add_error(Messages& messages, Place place, std::string_view slug, std::string message);
void add_command_line_error(Messages& messages, std::string_view slug, std::string message);  // has no place
void add_warning(Messages& messages, Place place, std::string_view slug, std::string message);

// "b.yaml:3:7" for a place, or only "3:7" where it is in the file of `from`.
std::string place_text(const Messages& messages, Place place, Place from);

// True while errors are kept: costly hints need not be worked out beyond that.
bool wants_errors(const Messages& messages);

// True while warnings of this slug are kept.
bool wants_warnings(const Messages& messages, std::string_view slug);

// Throws UserError with everything collected, in the order of the files; does nothing without errors.
void throw_errors(Messages& messages);

// Appends the collected warnings, and one line for each slug of which some were dropped, to `warnings`.
void hand_over_warnings(Messages& messages, std::vector<Diagnostic>& warnings);

}  // namespace patchlight
