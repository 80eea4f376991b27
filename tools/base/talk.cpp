// Messages -> standard error. Where that fails there is nobody left to tell, so its errors are not looked at.
#include "tools/base/talk.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace patchlight {
namespace {

constexpr std::chrono::seconds kProgressEvery{3};

void write_error_text(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(STDERR_FILENO, text.data(), text.size());
    if (count <= 0) return;
    text.remove_prefix(static_cast<size_t>(count));
  }
}

void close_progress_line(Talk& talk) {
  if (talk.line_open) write_error_text("\r\x1b[K");
  talk.line_open = false;
}

}  // namespace

Talk make_talk(const Options& options) {
  Talk talk;
  talk.quiet = options.quiet;
  talk.json = options.json;
  talk.terminal = isatty(STDERR_FILENO) == 1;
  const char* no_color = std::getenv("NO_COLOR");
  const bool wanted = talk.terminal && (no_color == nullptr || *no_color == '\0');
  talk.color = options.color == ColorChoice::kAlways || (options.color == ColorChoice::kAuto && wanted);
  talk.progress_last = std::chrono::steady_clock::now();
  return talk;
}

std::string color_diagnostic(const Diagnostic& diagnostic) {
  std::string text = format_diagnostic(diagnostic);
  const bool error = diagnostic.severity == Severity::kError;
  const std::string word = fmt::format("{}[{}]", error ? "error" : "warning", diagnostic.slug);
  const size_t place = text.find(word);
  if (place == std::string::npos) return text;
  return text.replace(place, word.size(), fmt::format("\x1b[{}m{}\x1b[0m", error ? "1;31" : "1;35", word));
}

void say_diagnostics(Talk& talk, const std::vector<Diagnostic>& diagnostics) {
  talk.said.insert(talk.said.end(), diagnostics.begin(), diagnostics.end());
  close_progress_line(talk);
  if (talk.json) return;
  for (const Diagnostic& diagnostic : diagnostics)
    write_error_text(talk.color ? color_diagnostic(diagnostic) : format_diagnostic(diagnostic));
}

void say_warning(Talk& talk, std::string_view slug, const std::string& message, const std::string& file) {
  Diagnostic diagnostic;
  diagnostic.severity = Severity::kWarning;
  diagnostic.slug = slug;
  diagnostic.message = message;
  diagnostic.file = file;
  say_diagnostics(talk, {diagnostic});
}

void say(Talk& talk, std::string_view line) {
  if (talk.quiet) return;
  close_progress_line(talk);
  write_error_text(fmt::format("{}\n", line));
}

void say_progress(Talk& talk, const std::string& line) {
  if (talk.quiet) return;
  if (talk.terminal) {
    // Cut to the shortest usual terminal: a wrapped line could not be rewritten.
    write_error_text(fmt::format("\r\x1b[K{}", line.substr(0, 79)));
    talk.line_open = true;
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - talk.progress_last < kProgressEvery) return;
  talk.progress_last = now;
  write_error_text(line + "\n");
}

void say_progress_done(Talk& talk) { close_progress_line(talk); }

}  // namespace patchlight
