// Every line of a scene, damaged in the ways that slips of an editor damage it.
#include "support.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <functional>

using namespace patchlight::testing;

namespace {

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size() - 1);
    lines.push_back(text.substr(at, end + 1 - at));
    at = end + 1;
  }
  return lines;
}

std::string join_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

// The line without the first of these characters.
std::string without(std::string line, const char* characters) {
  const size_t at = line.find_first_of(characters);
  return at == std::string::npos ? line : line.erase(at, 1);
}

// The line without its end, which is put behind what `change` makes of it.
std::string inner(const std::string& line, const std::function<std::string(std::string)>& change) {
  const size_t end = line.ends_with('\n') ? line.size() - 1 : line.size();
  return change(line.substr(0, end)) + line.substr(end);
}

using Change = std::function<std::string(const std::string& line)>;

const std::vector<Change>& changes() {
  static const std::vector<Change> all = {
      [](const std::string&) { return std::string(); },
      [](const std::string& line) { return line + line; },
      [](const std::string& line) { return " " + line; },
      [](const std::string& line) { return line.starts_with(' ') ? line.substr(1) : "- " + line; },
      [](const std::string& line) { return "\t" + line; },
      [](const std::string& line) { return without(line, ":"); },
      [](const std::string& line) { return without(line, "[{"); },
      [](const std::string& line) { return without(line, "]}"); },
      [](const std::string& line) { return without(line, ","); },
      [](const std::string& line) { return without(line, "-\"'"); },
      [](const std::string& line) { return inner(line, [](std::string text) { return text + ","; }); },
      [](const std::string& line) { return inner(line, [](std::string text) { return text + " x: 1"; }); },
      [](const std::string& line) { return inner(line, [](std::string text) { return text + " \"x"; }); },
      [](const std::string& line) {
        return inner(line, [](std::string text) { return text.substr(0, text.size() / 2); });
      },
      [](const std::string& line) { return "---\n" + line; },
      [](const std::string& line) { return inner(line, [](std::string text) { return text + "\xff"; }); },
  };
  return all;
}

}  // namespace

TEST_CASE("scenes with a damaged line end with a message, never worse") {
  ExitCounts counts;
  size_t turn = 0;
  for (const SceneText& scene : list_scenes()) {
    CAPTURE(scene.path);
    const std::vector<std::string> lines = split_lines(scene.text);
    for (size_t k = 0; k < lines.size(); ++k) {
      // Half of the changes a line, the others for the next: each change meets every kind of line somewhere.
      for (size_t c = turn++ % 2; c < changes().size(); c += 2) {
        std::vector<std::string> damaged = lines;
        damaged[k] = changes()[c](lines[k]);
        if (damaged[k] != lines[k]) check_text(scene, join_lines(damaged), counts);
      }
      const std::vector<std::string> head(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(k));
      check_text(scene, join_lines(head), counts);
    }
  }
  MESSAGE(counts[0], " still right, ", counts[3], " wrong, ", counts[4], " files, ", counts[5], " limits");
  CHECK(counts[0] > 100);
  CHECK(counts[3] > 1200);
}
