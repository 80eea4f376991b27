// A user's mistakes: what is said of them and how a run ends. One exception type carries them all to main.
#pragma once

#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

enum class Severity { kWarning, kError };

// One message. line and column are 1-based; 0 means that the message has no place (a flag, a file that is not
// there).
struct Diagnostic {
  Severity severity = Severity::kError;
  std::string file;
  int line = 0;
  int column = 0;
  std::string slug;         // stable name, e.g. unknown-material; the table of slugs is in diagnostics.cpp
  std::string message;      // what was found, what was expected; text from files already escaped
  std::string source_line;  // the line of the file, escaped and cut, for the caret; empty: not known
  bool from_command_line = false;  // -D or --set: a mistake of usage, not of the scene
  int caret = 0;                   // 1-based place of the caret under source_line; 0: under `column`
};

// Thrown for everything that the user can mend. `diagnostics` holds at least one error, all that were found
// in one go, in the order of the file; `more` counts those that were found beyond the limit and dropped.
struct UserError : std::exception {
  std::vector<Diagnostic> diagnostics;
  size_t more = 0;
  explicit UserError(std::vector<Diagnostic> list, size_t more_count = 0)
      : diagnostics(std::move(list)), more(more_count) {}
  UserError(std::string_view slug, std::string message, std::string file = {});
  const char* what() const noexcept override { return diagnostics.front().message.c_str(); }
};

// The slugs that do not mean that the scene is wrong, each with its exit code: 1 an expectation is missed, 2
// usage, 4 input/output, 5 a limit or memory.
struct SlugExit {
  std::string_view slug;
  int code;
};
std::span<const SlugExit> slug_exits();

// The exit code that belongs to a slug: 3, the scene is wrong, where it is not among slug_exits.
int exit_code(std::string_view slug);

// The same for a whole message: undefined-variable and non-finite are 2 when they come from the command line.
int exit_code(const Diagnostic& diagnostic);

// FILE:LINE:COL: error[slug]: message, then the source line and a caret. One text, newline at the end.
std::string format_diagnostic(const Diagnostic& diagnostic);

// Text from a file or the command line made safe to print: control characters, bidirectional overrides and
// bytes that are not UTF-8 become \xNN or \u{NNNN}; longer than `limit` characters is cut with an ellipsis.
std::string escape_text(std::string_view text, size_t limit = 60);

// The best of `known` for a mistyped `word`, or an empty string when none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace patchlight
