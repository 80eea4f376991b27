// Every value, key and name of a scene, one at a time, by what nobody should write there.
#include "support.h"

#include <doctest/doctest.h>

using namespace patchlight::testing;

namespace {

const std::vector<std::string>& replacements() {
  static const std::vector<std::string> all = {
      "",
      "~",
      "-1",
      "0",
      "1e309",
      "1e-320",
      "-1e300",
      ".nan",
      "99999999999",
      "18446744073709551616",
      "010",
      "\"0\"",
      "true",
      "word",
      "[]",
      "{}",
      "[1, 2]",
      "[1, 2, 3]",
      "{a: 1}",
      "$nosuch",
      "\"=1/0\"",
      "\"=((((1\"",
      "*alias",
      "&anchor",
      "!!tag 1",
      "<<",
      "\xc3\xa4\xe2\x82\xac",
      "\"\\x1b[31m\"",
      "\"\\0\"",
      "../../x",
      std::string(2000, 'x'),
      "1e15",
      "0.999999",
  };
  return all;
}

struct Range {
  size_t first, last;
};

// Where values, keys and names stand: runs between blanks and marks, comments left out.
std::vector<Range> list_scalars(const std::string& text) {
  std::vector<Range> ranges;
  for (size_t at = 0; at < text.size();) {
    if (text[at] == '#' && (at == 0 || text[at - 1] == ' ' || text[at - 1] == '\n')) {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    const size_t end = std::min(text.find_first_of(" \n,:[]{}\"", at), text.size());
    if (end > at && text.compare(at, end - at, "-") != 0) ranges.push_back({at, end});
    at = std::max(end, at + 1);
  }
  return ranges;
}

}  // namespace

TEST_CASE("scenes with a damaged value, key or name end with a message, never worse") {
  constexpr size_t kEach = 6;  // replacements a scalar; others for the next
  ExitCounts counts;
  size_t turn = 0;
  for (const SceneText& scene : list_scenes()) {
    CAPTURE(scene.path);
    for (const auto& [first, last] : list_scalars(scene.text))
      for (size_t k = 0; k < kEach; ++k) {
        std::string damaged = scene.text;
        damaged.replace(first, last - first, replacements()[turn++ % replacements().size()]);
        check_text(scene, damaged, counts);
      }
  }
  MESSAGE(counts[0], " still right, ", counts[3], " wrong, ", counts[4], " files, ", counts[5], " limits");
  CHECK(counts[0] > 400);
  CHECK(counts[3] > 6000);
  CHECK(counts[4] > 0);
}
