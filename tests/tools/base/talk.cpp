// Messages for people.
#include "tools/base/talk.h"

#include <doctest/doctest.h>

#include <cstdlib>

using namespace patchlight;

TEST_CASE("colour marks the severity and nothing else") {
  Diagnostic diagnostic;
  diagnostic.file = "a.yaml";
  diagnostic.line = 3;
  diagnostic.column = 4;
  diagnostic.slug = "unknown-key";
  diagnostic.message = "error[unknown-key] in the text stays as it is";
  const std::string text = color_diagnostic(diagnostic);
  CHECK(text.find("\x1b[1;31merror[unknown-key]\x1b[0m: ") != std::string::npos);
  CHECK(text.rfind("\x1b[") == text.find("\x1b[0m"));
}

TEST_CASE("--color is stronger than NO_COLOR") {
  setenv("NO_COLOR", "1", 1);
  Options options;
  CHECK(!make_talk(options).color);
  options.color = ColorChoice::kAlways;
  CHECK(make_talk(options).color);
  unsetenv("NO_COLOR");
  options.color = ColorChoice::kNever;
  CHECK(!make_talk(options).color);
}
