// The parser's own complaints to located messages that say what to write instead.
#include "dsl/yaml/yaml_errors.h"

#include <yaml-cpp/exceptions.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace patchlight {
namespace {

// What the parser says, and what we say instead. An empty text: the parser's own words are good enough.
struct Rewording {
  std::string_view parser;
  std::string_view ours;
};
constexpr std::array kRewordings = {
    Rewording{"end of map not found",
              "this line is indented like none of the maps above it; line it up with its siblings"},
    Rewording{"end of sequence not found",
              "a list item ('- ...') is expected here, or a line that is indented like its siblings"},
    Rewording{
        "illegal map value",
        "no ':' can stand here; did you forget a space after ':', or quotes around a text that holds ': '?"},
    Rewording{"illegal map key", "no key can stand here; line it up with its siblings"},
    Rewording{"illegal block entry", "no list item ('- ...') can stand here; put it on a line of its own"},
    Rewording{"illegal flow end", "this bracket closes nothing"},
    Rewording{"end of map flow not found", "a ',' or '}' is missing before this"},
    Rewording{"end of sequence flow not found", "a ',' or ']' is missing before this"},
    Rewording{"unknown escape character",
              "unknown escape in a double-quoted text; write \\\\ for a backslash or use single quotes"},
    Rewording{"YAML major version too large",
              "this YAML version is unknown; write %YAML 1.2 or take the line out"},
    Rewording{"unknown token", "no text can begin with this character; put it in quotes"},
    Rewording{"the referenced anchor is not defined",
              "this alias (*name) names nothing that was anchored (&name) before"},
    Rewording{"bad file", "nested deeper than the parser allows"},
    Rewording{"alias not found after", "a name belongs behind *; a text that begins with it needs quotes"},
    Rewording{"anchor not found after", "a name belongs behind &; a text that begins with it needs quotes"},
    Rewording{"scanning hex number", "\\x wants two hexadecimal digits, \\u four, \\U eight"},
    Rewording{"invalid unicode", "this number stands for no character"},
    Rewording{"repeated YAML directive", "%YAML stands here for the second time; take one out"},
};

std::string_view text_of_line(const SourceFile& file, uint32_t line) {
  size_t first = 0;
  for (uint32_t k = 1; k < line; ++k) {
    first = file.text.find('\n', first);
    if (first++ == std::string::npos) return {};
  }
  const std::string_view text = std::string_view(file.text).substr(first);
  return text.substr(0, text.find('\n'));
}

// "units:cm" reads as a text; the parser complains only at the next ':'. This finds that earlier line.
uint32_t line_without_space(const SourceFile& file, uint32_t line) {
  for (uint32_t k = line; k >= 1 && k + 3 > line; --k) {
    const std::string_view text = text_of_line(file, k);
    const size_t key = text.find_first_not_of(" -");
    const size_t colon = text.find(':');
    if (key == std::string_view::npos || colon == std::string_view::npos || colon + 1 >= text.size())
      continue;
    if (text[colon + 1] != ' ' && text[colon + 1] != '\r' && text.find_first_of(" \"'[{#") > colon) return k;
  }
  return 0;
}

}  // namespace

void report_yaml_error(Messages& messages, uint32_t file, const YAML::Exception& error) {
  Place place{file, 1, 1};
  if (!error.mark.is_null())
    place = {file, static_cast<uint32_t>(error.mark.line + 1), static_cast<uint32_t>(error.mark.column + 1)};
  std::string message = error.msg;
  for (const Rewording& row : kRewordings)
    if (error.msg.find(row.parser) != std::string::npos) message = row.ours;
  std::string_view slug = "yaml-syntax";
  if (error.msg.find("anchor is not defined") != std::string::npos) slug = "yaml-undefined-alias";
  if (error.msg.find("bad file") != std::string::npos) slug = "too-deep";
  const std::string_view line = text_of_line(messages.files[file], place.line);
  const size_t indent = std::min(line.find_first_not_of(' '), line.size());
  if (error.msg.find("end of map not found") != std::string::npos && place.column > indent + 1)
    message = "this does not belong behind what stands before it; is a ',', a ':' or a line break missing?";
  // The parser's mark is behind the character that it could not read.
  if (error.msg.find("unknown escape") != std::string::npos && place.column > 1) --place.column;
  if (error.msg.find("illegal map value") != std::string::npos) {
    if (line.substr(indent).starts_with('-') && line.substr(indent, 2) != "- ") {
      const bool tab = line.substr(indent, 2) == "-\t";
      place.column = static_cast<uint32_t>(indent + 1);
      message = tab ? "a tab may not stand between '-' and a key; use a space"
                    : "a space is missing after this '-'";
      if (tab) slug = "yaml-tab-indent";
    } else if (const uint32_t earlier = line_without_space(messages.files[file], place.line)) {
      place.line = earlier;
      place.column = 1;
    }
  }
  add_error(messages, place, slug, escape_text(message, 200));
}

}  // namespace patchlight
