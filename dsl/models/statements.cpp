// Text of Wavefront files to statements, words and numbers.
#include "dsl/models/statements.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace patchlight {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

// Length of the blank at the start of a text: a backslash before a line's end is one.
size_t blank_length(std::string_view text) {
  if (is_blank(text[0])) return 1;
  if (text[0] != '\\') return 0;
  if (text.substr(1).starts_with('\n')) return 2;
  return text.substr(1).starts_with("\r\n") ? 3 : 0;
}

std::string_view without_blanks_before(std::string_view text) {
  while (!text.empty()) {
    const size_t length = blank_length(text);
    if (length == 0) break;
    text.remove_prefix(length);
  }
  return text;
}

// Where the statement that begins at `first` ends: behind its last line's end.
size_t end_of_statement(std::string_view text, size_t first, uint32_t& lines) {
  for (size_t from = first;;) {
    const size_t end = text.find('\n', from);
    if (end == std::string_view::npos) return text.size();
    ++lines;
    const size_t last = end > first && text[end - 1] == '\r' ? end - 1 : end;
    if (last == first || text[last - 1] != '\\') return end + 1;
    from = end + 1;
  }
}

}  // namespace

StatementReader read_statements(const Messages& messages, uint32_t file) {
  StatementReader reader;
  reader.text = messages.files[file].text;
  reader.file = file;
  if (reader.text.starts_with("\xef\xbb\xbf")) reader.next = 3;
  return reader;
}

bool next_statement(StatementReader& reader, std::string_view& keyword) {
  while (reader.next < reader.text.size()) {
    reader.first = reader.next;
    reader.line = reader.next_line;
    reader.next = end_of_statement(reader.text, reader.first, reader.next_line);
    reader.rest = reader.text.substr(reader.first, reader.next - reader.first);
    keyword = next_word(reader);
    if (!keyword.empty() && keyword[0] != '#') return true;
  }
  return false;
}

std::string_view next_word(StatementReader& reader) {
  const std::string_view text = without_blanks_before(reader.rest);
  size_t length = 0;
  while (length < text.size() && !is_blank(text[length]) &&
         (text[length] != '\\' || blank_length(text.substr(length)) == 0))
    ++length;
  reader.rest = text.substr(length);
  return text.substr(0, length);
}

std::string_view rest_of(const StatementReader& reader) {
  std::string_view text = without_blanks_before(reader.rest);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

Place place_of(const StatementReader& reader, std::string_view word) {
  Place place{reader.file, reader.line, 1};
  // An empty word stands at the statement's beginning.
  const auto offset = word.empty() ? reader.first : static_cast<size_t>(word.data() - reader.text.data());
  for (size_t k = reader.first; k < offset; ++k) {
    ++place.column;
    if (reader.text[k] == '\n') ++place.line, place.column = 1;
  }
  return place;
}

bool next_number(Messages& messages, StatementReader& reader, double& value) {
  const std::string_view word = next_word(reader);
  const auto fail = [&](std::string_view slug, std::string message) {
    add_error(messages, place_of(reader, word), slug, std::move(message));
    return false;
  };
  if (word.empty()) return fail("mesh-invalid", "a number is missing in this line");
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = error != std::errc::invalid_argument && end == digits.data() + digits.size();
  // 1.#IND and the like are what some C libraries print for what is no number.
  const bool printed = error == std::errc{} && !whole && *end == '#';
  if (printed || (whole && error == std::errc{} && !std::isfinite(value)))
    return fail("non-finite", fmt::format("expected a finite number, got '{}'", escape_text(word)));
  if (!whole)
    return fail(
        "mesh-invalid",
        fmt::format("expected a number like 2, -0.5 or 1e-3, got '{}'{}", escape_text(word),
                    word.find(',') != std::string_view::npos ? "; decimals have a point, not a comma" : ""));
  if (error == std::errc::result_out_of_range) {
    const size_t exponent = digits.find_first_of("eE");
    const bool small = (exponent != std::string_view::npos && digits.substr(exponent + 1).starts_with('-')) ||
                       digits.starts_with("0.") || digits.starts_with("-0.");
    if (!small)
      return fail("number-out-of-range", fmt::format("'{}' is too large for a number", escape_text(word)));
    value = 0;
  }
  return true;
}

}  // namespace patchlight
