// Messages: escaping, hints, exit codes, the printed form.
#include "dsl/report/diagnostics.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

TEST_CASE("text from a file cannot reach the terminal raw") {
  CHECK(escape_text("\x1b[31mred") == "\\x1b[31mred");
  CHECK(escape_text("a\nb\x7f") == "a\\x0ab\\x7f");
  CHECK(escape_text("caf\xe9") == "caf\\xe9");
  CHECK(escape_text("\xe2\x80\xae!") == "\\u{202e}!");
  CHECK(escape_text("\xc3\xa4\xe2\x82\xac") == "\xc3\xa4\xe2\x82\xac");
  CHECK(escape_text(std::string(100, 'x')) == std::string(60, 'x') + "...");
}

TEST_CASE("the nearest word is offered, a far one is not") {
  const std::vector<std::string> known = {"camera", "cameras", "solver"};
  CHECK(did_you_mean("camrea", known) == "camera");
  CHECK(did_you_mean("Solver", known) == "solver");
  CHECK(did_you_mean("zebra", known) == "");
  CHECK(did_you_mean("x", known) == "");
}

TEST_CASE("exit codes follow from slugs") {
  CHECK(exit_code("usage") == 2);
  CHECK(exit_code("unknown-key") == 3);
  CHECK(exit_code("cannot-open") == 4);
  CHECK(exit_code("too-many-patches") == 5);
}

TEST_CASE("a message names place and slug and shows the line") {
  Diagnostic diagnostic;
  diagnostic.file = "scene.yaml";
  diagnostic.line = 7;
  diagnostic.column = 3;
  diagnostic.slug = "unknown-key";
  diagnostic.message = "unknown key 'x'";
  diagnostic.source_line = "  x: 1";
  CHECK(format_diagnostic(diagnostic) ==
        "scene.yaml:7:3: error[unknown-key]: unknown key 'x'\n    x: 1\n    ^\n");
}

}  // namespace
}  // namespace patchlight::test
