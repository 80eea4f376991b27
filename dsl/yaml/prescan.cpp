// A light scan of YAML before the parser. It knows comments, quotes, brackets, block texts (| and >) and
// where a plain text ends; it does not know what the document means.
#include "dsl/yaml/prescan.h"

#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <vector>

namespace patchlight {
namespace {

constexpr uint32_t kKeyBytesMax = 1000;  // YAML itself allows 1024

struct Bracket {
  char opener;
  Place place;
};

struct Scan {
  Messages& messages;
  uint32_t file;
  std::string_view text;
  size_t at = 0;
  uint32_t line = 1;
  size_t line_first = 0;
  std::vector<Bracket> brackets;
  uint32_t parent_column = 0;  // of the key or dash that the current value belongs to, 1-based
  bool after_plain = false;    // the last token was plain text: what follows may continue it
  bool failed = false;

  bool done() const { return at >= text.size(); }
  char peek(size_t ahead = 0) const { return at + ahead < text.size() ? text[at + ahead] : '\0'; }
  Place place() const { return {file, line, static_cast<uint32_t>(at - line_first + 1)}; }
  void fail(Place where, std::string_view slug, std::string message) {
    add_error(messages, where, slug, std::move(message));
    failed = true;
  }
  void new_line() {
    ++line;
    line_first = at;
  }
};

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_break(char c) { return c == '\n' || c == '\r' || c == '\0'; }
bool is_flow_mark(char c) { return c == ',' || c == '[' || c == ']' || c == '{' || c == '}'; }
bool ends_token(char c) { return is_blank(c) || is_break(c); }

void skip_line(Scan& scan) {
  const size_t end = scan.text.find('\n', scan.at);
  scan.at = end == std::string_view::npos ? scan.text.size() : end;
}

// A quoted text, from its opening quote. Afterwards only what can follow a value may stand there.
void scan_quoted(Scan& scan) {
  const Place opened = scan.place();
  const char quote = scan.peek();
  for (++scan.at;; ++scan.at) {
    if (scan.done())
      return scan.fail(opened, "yaml-unterminated-string",
                       fmt::format("the text opened here with {} is never closed", quote));
    const char c = scan.peek();
    if (c == '\n') {
      ++scan.line;
      scan.line_first = scan.at + 1;
    } else if (quote == '"' && c == '\\') {
      ++scan.at;
      if (scan.peek() == '\n') {
        ++scan.line;
        scan.line_first = scan.at + 1;
      }
    } else if (c == quote) {
      if (quote == '\'' && scan.peek(1) == '\'')
        ++scan.at;
      else
        break;
    }
  }
  ++scan.at;
  size_t next = scan.at;
  while (next < scan.text.size() && is_blank(scan.text[next])) ++next;
  const char follower = next < scan.text.size() ? scan.text[next] : '\n';
  const bool fits = is_break(follower) || follower == ':' || (follower == '#' && next > scan.at) ||
                    (!scan.brackets.empty() && (follower == ',' || follower == ']' || follower == '}'));
  if (!fits)
    scan.fail({scan.file, scan.line, static_cast<uint32_t>(next - scan.line_first + 1)}, "yaml-syntax",
              fmt::format(
                  "'{}' after the closing quote of the text opened at {}:{}; is a quote missing or too many?",
                  escape_text(scan.text.substr(next, 1)), opened.line, opened.column));
}

// A block text (| or >): its lines are those indented deeper than the key or dash that it belongs to.
void scan_block_text(Scan& scan) {
  const uint32_t parent = scan.parent_column;
  skip_line(scan);
  while (!scan.done()) {
    size_t first = scan.at + 1;
    while (first < scan.text.size() && scan.text[first] == ' ') ++first;
    const bool blank = first >= scan.text.size() || is_break(scan.text[first]);
    if (!blank && first - scan.at <= parent) return;
    ++scan.at;
    scan.new_line();
    skip_line(scan);
  }
}

void scan_close(Scan& scan) {
  const char closer = scan.peek();
  if (scan.brackets.empty())
    return scan.fail(scan.place(), "yaml-syntax",
                     fmt::format("'{}' closes nothing; quote the text if it belongs to it", closer));
  const Bracket open = scan.brackets.back();
  const char expected = open.opener == '[' ? ']' : '}';
  if (closer != expected)
    return scan.fail(scan.place(), "yaml-syntax",
                     fmt::format("'{}' found, but the '{}' opened at {}:{} wants '{}'", closer, open.opener,
                                 open.place.line, open.place.column, expected));
  scan.brackets.pop_back();
  ++scan.at;
}

void scan_open(Scan& scan) {
  const Limits& limits = scan.messages.limits;
  if (scan.brackets.size() >= limits.nesting)
    return scan.fail(scan.place(), "too-deep",
                     fmt::format("nested deeper than the limit of {}", limit_text(limits, &Limits::nesting)));
  scan.brackets.push_back({scan.peek(), scan.place()});
  ++scan.at;
}

// Plain text up to where it ends on this line.
void scan_plain(Scan& scan) {
  const Place begin = scan.place();
  const bool flow = !scan.brackets.empty();
  while (!is_break(scan.peek())) {
    const char c = scan.peek();
    if (c == ':' && (ends_token(scan.peek(1)) || (flow && is_flow_mark(scan.peek(1))))) {
      if (!flow) scan.parent_column = begin.column;
      if (scan.place().column - begin.column > kKeyBytesMax)
        scan.fail(begin, "unknown-key",
                  fmt::format("unknown key '{}': no key is that long",
                              escape_text(scan.text.substr(scan.line_first + begin.column - 1, 100))));
      return;
    }
    if (c == '#' && scan.at > 0 && is_blank(scan.text[scan.at - 1])) return;
    if (flow && is_flow_mark(c)) {
      if (c == '{' && scan.text[scan.at - 1] == '$')
        scan.fail({scan.file, scan.line, scan.place().column - 1}, "yaml-syntax",
                  "${...} is not YAML inside brackets; write $name, or \"=...\" for an expression");
      return;
    }
    if (static_cast<uint8_t>(c) < 0x20 && c != '\t')
      return scan.fail(scan.place(), "control-character",
                       fmt::format("control character {:#04x}; take it out", static_cast<uint8_t>(c)));
    ++scan.at;
  }
}

// The blanks at the start of a line; false when a tab indents.
bool scan_indent(Scan& scan) {
  while (scan.peek() == ' ') ++scan.at;
  if (scan.text.substr(scan.at, 2) == "\xc2\xa0") {
    scan.fail(scan.place(), "yaml-syntax", "a no-break space (U+00A0) may not indent YAML; use spaces");
    return false;
  }
  if (scan.peek() != '\t' || !scan.brackets.empty()) return true;
  const Place tab = scan.place();
  while (is_blank(scan.peek())) ++scan.at;
  if (is_break(scan.peek()) || scan.peek() == '#') return true;
  scan.fail({tab.file, tab.line, 1}, "yaml-tab-indent", "a tab may not indent YAML; use spaces");
  return false;
}

// One token, which starts at a character that is neither blank nor a line break.
void scan_token(Scan& scan) {
  const char c = scan.peek();
  const bool flow = !scan.brackets.empty();
  const bool indicator = (c == '-' || c == '?' || c == ':') && ends_token(scan.peek(1));
  const bool flow_colon = c == ':' && flow;
  if (flow && c == ',') {
    scan.after_plain = false;
    ++scan.at;
  } else if (indicator || flow_colon) {
    if (!flow && c != ':') scan.parent_column = scan.place().column;
    scan.after_plain = false;
    ++scan.at;
  } else if (flow && (c == ']' || c == '}')) {
    scan.after_plain = false;
    scan_close(scan);
  } else if (scan.after_plain) {
    scan_plain(scan);
    scan.after_plain = scan.peek() != ':' || !ends_token(scan.peek(1));
    if (scan.peek() == ':' && !scan.after_plain) return;
    if (flow && (scan.peek() == '[' || scan.peek() == '{')) scan_open(scan);
  } else if (c == '"' || c == '\'') {
    const uint32_t column = scan.place().column;
    scan_quoted(scan);
    if (!flow && scan.peek() == ':') scan.parent_column = column;
  } else if (c == '[' || c == '{') {
    scan_open(scan);
  } else if (!flow && (c == ']' || c == '}')) {
    scan_close(scan);
  } else if (!flow && (c == '|' || c == '>')) {
    scan_block_text(scan);
  } else if (c == '&' || c == '!' || c == '*') {
    while (!ends_token(scan.peek()) && !(flow && is_flow_mark(scan.peek()))) ++scan.at;
  } else {
    scan_plain(scan);
    scan.after_plain = true;
  }
}

}  // namespace

bool prescan(Messages& messages, uint32_t file) {
  Scan scan{messages, file, messages.files[file].text, 0, 1, 0, {}, 0, false, false};
  if (const size_t zero = scan.text.find('\0'); zero != std::string_view::npos) {
    for (; scan.at < zero; ++scan.at)
      if (scan.peek() == '\n') scan.line += 1, scan.line_first = scan.at + 1;
    scan.fail(scan.place(), "control-character", "a zero byte; is this a text file?");
    return false;
  }
  bool line_start = true;
  while (!scan.done() && !scan.failed) {
    if (line_start) {
      line_start = false;
      if (!scan_indent(scan)) break;
      const uint32_t column = scan.place().column;
      // A line that is not indented deeper than its key starts something new.
      if (scan.brackets.empty() && !is_break(scan.peek()) && column <= scan.parent_column) {
        scan.after_plain = false;
        scan.parent_column = 0;
      }
    }
    const char c = scan.peek();
    if (c == '\n') {
      ++scan.at;
      scan.new_line();
      line_start = true;
    } else if (is_blank(c) || (c == '\r' && scan.peek(1) == '\n')) {
      ++scan.at;
    } else if (c == '#' && (scan.at == scan.line_first || is_blank(scan.text[scan.at - 1]) ||
                            is_flow_mark(scan.text[scan.at - 1]))) {
      skip_line(scan);
    } else if (c == '\r') {
      scan.fail(scan.place(), "control-character",
                "a carriage return without a line feed; save with LF or CRLF line ends");
    } else {
      scan_token(scan);
    }
  }
  if (!scan.failed && !scan.brackets.empty())
    scan.fail(scan.brackets.back().place, "yaml-syntax",
              fmt::format("the '{}' opened here is never closed", scan.brackets.back().opener));
  return !scan.failed;
}

}  // namespace patchlight
