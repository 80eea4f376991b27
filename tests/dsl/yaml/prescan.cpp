// What the light scan lets through and what it stops.
#include "dsl/yaml/prescan.h"

#include <doctest/doctest.h>

#include <string>

namespace patchlight::test {
namespace {

std::string scan(const std::string& text, int line = 0, int column = 0) {
  Messages messages;
  messages.files.push_back({"t.yaml", text});
  if (prescan(messages, 0)) return "";
  REQUIRE(messages.errors.size() == 1);
  if (line > 0) {
    CHECK(messages.errors[0].line == line);
    CHECK(messages.errors[0].column == column);
  }
  return messages.errors[0].slug;
}

TEST_CASE("quotes, brackets and marks that are only text pass") {
  for (const char* text : {"title: it's fine\n",
                           "title: say \"hello\"\n",
                           "title: a [b\n",
                           "a: 'it''s [ok'\n",
                           "a: \"x\\\"y\" # 'comment\n",
                           "# don't\na: 1\n",
                           "a: b # it's [\n",
                           "a: |\n  it's [\n  \"open\nb: 1\n",
                           "a: >-\n  don't\n\n  [\n",
                           "a:\n  - |\n    'x\n  - 2\n",
                           "a: it\n  isn't\n",
                           "a: {b: c's, d: [e, 'f']}\n",
                           "a: 5#'x\n",
                           "a: &x 'b'\nc: *x\n",
                           "a: [1,\n\t2]\n",
                           "a: 1\n\t\nb: 2\n",
                           "'a': 1\n\"b\" : 2\n",
                           "- 'a'\n- \"b\"\n",
                           "url: http://x'y\n",
                           "a: {'b': 1, \"c\":2}\n",
                           "a: [b\n  's]\n",
                           "a: !!str 'x'\n",
                           "a:\n- 'b'\n-\n  \"c\"\n",
                           "a: '\n\n  b'\nc: 1\n"}) {
    CAPTURE(text);
    CHECK(scan(text) == "");
  }
}

TEST_CASE("what stays open is named at its opening") {
  CHECK(scan("a: 1\nb: 'x\nc: 2\n", 2, 4) == "yaml-unterminated-string");
  CHECK(scan("a: [1, {b: 2]\n", 1, 13) == "yaml-syntax");
  CHECK(scan("a: [1, [2]\nb: 3\n", 1, 4) == "yaml-syntax");
  CHECK(scan("a: 1]\n") == "");
  CHECK(scan("a: ]\n", 1, 4) == "yaml-syntax");
  CHECK(scan("a: 'b' c\n", 1, 8) == "yaml-syntax");
  CHECK(scan("a:\n  b: 1\n\tc: 2\n", 3, 1) == "yaml-tab-indent");
  CHECK(scan("a: 1\rb: 2\n", 1, 5) == "control-character");
  CHECK(scan("a: [${w}]\n", 1, 5) == "yaml-syntax");
}

}  // namespace
}  // namespace patchlight::test
