// Messages to text: the table of slugs, escaping, and the nearest word for a mistyped one.
#include "dsl/report/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace patchlight {
namespace {

constexpr std::array kSlugExits = {
    SlugExit{"expectation-missed", 1}, SlugExit{"usage", 2},
    SlugExit{"cannot-open", 4},        SlugExit{"cannot-write", 4},
    SlugExit{"include-not-found", 4},  SlugExit{"not-a-regular-file", 4},
    SlugExit{"output-locked", 4},      SlugExit{"write-failed", 4},
    SlugExit{"file-too-large", 5},     SlugExit{"image-too-large", 5},
    SlugExit{"memory-limit", 5},       SlugExit{"out-of-memory", 5},
    SlugExit{"time-limit", 5},         SlugExit{"too-many-includes", 5},
    SlugExit{"too-many-patches", 5},   SlugExit{"too-many-polygons", 5},
};

// Bytes of the UTF-8 character that starts here and its code point; length 0: not UTF-8.
struct Utf8Character {
  uint32_t code = 0;
  size_t length = 0;
};

Utf8Character decode(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t b0 = byte(0);
  if (b0 < 0x80) return {b0, 1};
  const size_t length = b0 >= 0xf0 ? 4 : b0 >= 0xe0 ? 3 : 2;
  if (b0 < 0xc2 || b0 > 0xf4 || text.size() < length) return {};
  uint32_t code = b0 & (0xffu >> (length + 1));
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  if ((length == 3 && code < 0x800) || (length == 4 && (code < 0x10000 || code > 0x10ffff))) return {};
  if (code >= 0xd800 && code <= 0xdfff) return {};
  return {code, length};
}

// Characters that do something to a terminal or to the order of the text around them, and blanks that look
// like others.
bool unsafe_to_print(uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code <= 0xa0) || code == 0xad || code == 0x61c || code == 0x180e ||
         (code >= 0x2000 && code <= 0x200f) || (code >= 0x2028 && code <= 0x202f) ||
         (code >= 0x2060 && code <= 0x206f) || code == 0xfeff || (code >= 0xfff9 && code <= 0xfffb) ||
         (code >= 0xe0000 && code <= 0xe007f);
}

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// Edits (insert, delete, replace, swap neighbours) that make one word the other.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

}  // namespace

UserError::UserError(std::string_view slug, std::string message, std::string file) {
  Diagnostic diagnostic;
  diagnostic.slug = slug;
  diagnostic.message = std::move(message);
  diagnostic.file = std::move(file);
  diagnostics.push_back(std::move(diagnostic));
}

std::span<const SlugExit> slug_exits() { return kSlugExits; }

int exit_code(std::string_view slug) {
  for (const SlugExit& row : kSlugExits)
    if (row.slug == slug) return row.code;
  return 3;
}

int exit_code(const Diagnostic& diagnostic) {
  const bool usage = diagnostic.slug == "undefined-variable" || diagnostic.slug == "non-finite";
  return diagnostic.from_command_line && usage ? 2 : exit_code(diagnostic.slug);
}

std::string format_diagnostic(const Diagnostic& diagnostic) {
  std::string text = escape_text(diagnostic.file, 4096);
  if (diagnostic.line > 0) text += fmt::format(":{}:{}", diagnostic.line, diagnostic.column);
  if (!text.empty()) text += ": ";
  text += diagnostic.severity == Severity::kError ? "error" : "warning";
  text += fmt::format("[{}]: {}\n", diagnostic.slug, diagnostic.message);
  if (!diagnostic.source_line.empty()) {
    text += fmt::format("  {}\n", diagnostic.source_line);
    const int caret = diagnostic.caret > 0 ? diagnostic.caret : diagnostic.column;
    text += fmt::format("  {:>{}}\n", "^", std::max(caret, 1));
  }
  return text;
}

std::string escape_text(std::string_view text, size_t limit) {
  std::string out;
  size_t shown = 0;
  while (!text.empty()) {
    if (shown++ == limit) return out + "...";
    const Utf8Character character = decode(text);
    if (character.length == 0) {
      out += fmt::format("\\x{:02x}", static_cast<uint8_t>(text[0]));
      text.remove_prefix(1);
      continue;
    }
    if (unsafe_to_print(character.code))
      out += character.code < 0x100 ? fmt::format("\\x{:02x}", character.code)
                                    : fmt::format("\\u{{{:04x}}}", character.code);
    else
      out += text.substr(0, character.length);
    text.remove_prefix(character.length);
  }
  return out;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  if (word.empty() || word.size() > 60) return {};
  const std::string lower = lower_case(word);
  const size_t near = std::max<size_t>(1, word.size() / 3);
  size_t best = near + 1;
  const std::string* found = nullptr;
  for (const std::string& candidate : known) {
    const size_t distance = edit_distance(lower, lower_case(candidate));
    if (distance < best && distance < candidate.size()) {
      best = distance;
      found = &candidate;
    }
  }
  return found ? *found : std::string{};
}

}  // namespace patchlight
