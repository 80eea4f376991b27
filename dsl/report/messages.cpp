// Places and words to diagnostics, with the line of the file and the caret's place in it.
#include "dsl/report/messages.h"

#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr size_t kLineShown = 100;  // characters of a source line that a message shows
constexpr size_t kLineBefore = 60;  // of them before the caret, in a line that is too long

std::string_view line_of(std::string_view text, uint32_t line) {
  size_t first = 0;
  for (uint32_t k = 1; k < line; ++k) {
    const size_t end = text.find('\n', first);
    if (end == std::string_view::npos) return {};
    first = end + 1;
  }
  std::string_view rest = text.substr(first);
  rest = rest.substr(0, rest.find('\n'));
  if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
  return rest;
}

bool continues_character(char c) { return (static_cast<uint8_t>(c) & 0xc0) == 0x80; }

size_t count_characters(std::string_view text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues_character(c); }));
}

Diagnostic make_diagnostic(const Messages& messages, Place place, std::string_view slug, std::string message,
                           Severity severity) {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.slug = slug;
  diagnostic.message = std::move(message);
  if (place.file >= messages.files.size()) return diagnostic;
  const SourceFile& file = messages.files[place.file];
  diagnostic.file = file.name;
  diagnostic.from_command_line = file.command_line;
  diagnostic.line = static_cast<int>(place.line);
  diagnostic.column = static_cast<int>(place.column);
  if (place.line == 0) return diagnostic;
  const std::string_view line = line_of(file.text, place.line);
  const std::string_view before = line.substr(0, std::min<size_t>(place.column - 1, line.size()));
  diagnostic.column = static_cast<int>(count_characters(before)) + 1;
  size_t first = 0;
  if (line.size() > kLineShown && before.size() > kLineBefore) first = before.size() - kLineBefore;
  while (first > 0 && first < line.size() && continues_character(line[first])) --first;
  const std::string lead = first > 0 ? "..." : "";
  diagnostic.source_line = lead + escape_text(line.substr(first), kLineShown);
  diagnostic.caret = static_cast<int>(count_characters(
                         lead + escape_text(before.substr(std::min(first, before.size())), kLineShown))) +
                     1;
  return diagnostic;
}

// The row of a slug among those that were warned of, or the end.
template <class Counts>
auto find_count(Counts& counts, std::string_view slug) {
  return std::find_if(counts.begin(), counts.end(),
                      [&](const Messages::Count& row) { return row.slug == slug; });
}

bool earlier(const Diagnostic& a, const Diagnostic& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

}  // namespace

void add_error(Messages& messages, Place place, std::string_view slug, std::string message) {
  if (wants_errors(messages))
    messages.errors.push_back(make_diagnostic(messages, place, slug, std::move(message), Severity::kError));
  ++messages.error_count;
}

void add_command_line_error(Messages& messages, std::string_view slug, std::string message) {
  if (wants_errors(messages)) {
    messages.errors.push_back(
        make_diagnostic(messages, {~uint32_t{0}, 0, 0}, slug, std::move(message), Severity::kError));
    messages.errors.back().from_command_line = true;
  }
  ++messages.error_count;
}

void add_warning(Messages& messages, Place place, std::string_view slug, std::string message) {
  if (wants_warnings(messages, slug))
    messages.warnings.push_back(
        make_diagnostic(messages, place, slug, std::move(message), Severity::kWarning));
  const auto row = find_count(messages.warning_counts, slug);
  if (row == messages.warning_counts.end())
    messages.warning_counts.push_back({std::string(slug), 1});
  else
    ++row->count;
}

std::string place_text(const Messages& messages, Place place, Place from) {
  const std::string where = fmt::format("{}:{}", place.line, place.column);
  return place.file == from.file ? where : escape_text(messages.files[place.file].name, 200) + ":" + where;
}

bool wants_errors(const Messages& messages) { return messages.errors.size() < kErrorsShown; }

bool wants_warnings(const Messages& messages, std::string_view slug) {
  const auto row = find_count(messages.warning_counts, slug);
  return row == messages.warning_counts.end() || row->count < kWarningsShown;
}

void throw_errors(Messages& messages) {
  if (messages.errors.empty()) return;
  const size_t more = messages.error_count - messages.errors.size();
  // Only within a file: the files themselves stay in the order in which they were read.
  std::stable_sort(
      messages.errors.begin(), messages.errors.end(),
      [](const Diagnostic& a, const Diagnostic& b) { return a.file == b.file && earlier(a, b); });
  throw UserError(std::move(messages.errors), more);
}

void hand_over_warnings(Messages& messages, std::vector<Diagnostic>& warnings) {
  std::stable_sort(
      messages.warnings.begin(), messages.warnings.end(),
      [](const Diagnostic& a, const Diagnostic& b) { return a.file == b.file && earlier(a, b); });
  for (Diagnostic& warning : messages.warnings) warnings.push_back(std::move(warning));
  messages.warnings.clear();
  for (const Messages::Count& row : messages.warning_counts) {
    if (row.count <= kWarningsShown) continue;
    Diagnostic rest;
    rest.severity = Severity::kWarning;
    rest.file = messages.files.empty() ? std::string{} : messages.files.front().name;
    rest.slug = row.slug;
    rest.message = fmt::format("and {} more of these", row.count - kWarningsShown);
    warnings.push_back(std::move(rest));
  }
}

}  // namespace patchlight
