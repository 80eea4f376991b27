// What the program says on standard error: messages, progress, the summary.
#pragma once

#include "dsl/report/diagnostics.h"
#include "options.h"

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

struct Talk {
  bool quiet = false;
  bool json = false;  // messages are printed at the end, as one list
  bool color = false;
  bool terminal = false;  // standard error is one: progress rewrites its line
  bool line_open = false;
  std::vector<Diagnostic> said;
  std::chrono::steady_clock::time_point progress_last;
};

// Looks at standard error and at NO_COLOR.
Talk make_talk(const Options& options);

// Warnings and errors, each with its line and caret, or kept for the JSON list.
void say_diagnostics(Talk& talk, const std::vector<Diagnostic>& diagnostics);
void say_warning(Talk& talk, std::string_view slug, const std::string& message, const std::string& file);
// One line of plain words, unless quiet.
void say(Talk& talk, std::string_view line);
// Where the run stands: rewritten in place on a terminal, else a line every few seconds.
void say_progress(Talk& talk, const std::string& line);
// Takes the line away again, before results are printed.
void say_progress_done(Talk& talk);

// A message with its severity in colour.
std::string color_diagnostic(const Diagnostic& diagnostic);

}  // namespace patchlight
