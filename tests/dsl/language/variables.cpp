// Variables: order, the command line, repeats.
#include "dsl/language/variables.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace patchlight::test {
namespace {

Loaded load_with(const std::string& text, const LoadOptions& options) {
  Loaded loaded;
  try {
    loaded.scene = load_scene_text(text, "t.yaml", loaded.warnings, options);
  } catch (const UserError& error) {
    loaded.errors = error.diagnostics;
  }
  return loaded;
}

const std::string kWide = kHead + "  - {quad: {size: [$w, $h]}, material: lamp}\nlet: {h: '=$w*2', w: 3}\n";

TEST_CASE("let may be in any order, and -D is stronger") {
  const Loaded plain = load(kWide);
  REQUIRE(plain.errors.empty());
  CHECK(face_area(plain.scene, 0) == doctest::Approx(18));
  const Loaded defined = load_with(kWide, {{"w=1"}, {}});
  REQUIRE(defined.errors.empty());
  CHECK(face_area(defined.scene, 0) == doctest::Approx(2));
}

TEST_CASE("a chain of definitions may be long, in any order, and a ring of them is told once") {
  constexpr int kLong = 20'000;  // some 10 MB of stack, were each read where it is used
  std::string text = kHead + "  - {quad: {size: [$v0, 1]}, material: lamp}\nlet:\n";
  for (int k = 0; k < kLong; ++k) text += fmt::format("  v{}: '=$v{}+1'\n", k, k + 1);
  const Loaded chain = load(text + fmt::format("  v{}: 1\n", kLong));
  REQUIRE(chain.errors.empty());
  double area = 0;
  for (size_t f = 0; f < chain.scene.faces.size(); ++f) area += face_area(chain.scene, f);
  CHECK(area == doctest::Approx(kLong + 1));
  const Loaded ring = load(text + fmt::format("  v{}: $v100\n", kLong));
  REQUIRE(ring.errors.size() == 1);
  CHECK(ring.errors[0].slug == "variable-cycle");
  CHECK(ring.errors[0].message == "'v100' is defined by itself");
}

TEST_CASE("definitions are numbers as scenes have them") {
  const std::pair<const char*, double> rows[] = {{"w=+2", 2}, {"w=.5", 0.5}, {"w=2e0", 2}, {"w=5.", 5}};
  for (const auto& [definition, width] : rows) {
    CAPTURE(definition);
    const Loaded loaded = load_with(kWide, {{definition}, {}});
    REQUIRE(loaded.errors.empty());
    CHECK(face_area(loaded.scene, 0) == doctest::Approx(2 * width * width));
  }
}

TEST_CASE("definitions that are wrong are mistakes of usage") {
  const std::pair<const char*, const char*> rows[] = {{"nosuch=3", "undefined-variable"},
                                                      {"w=nan", "non-finite"},
                                                      {"w=inf", "non-finite"},
                                                      {"w=1e999", "non-finite"},
                                                      {"w", "usage"},
                                                      {"w=", "usage"},
                                                      {"=3", "usage"},
                                                      {"w=3x", "usage"},
                                                      {"w=.nan", "non-finite"},
                                                      {"w=-.inf", "non-finite"},
                                                      {"w=010", "usage"},
                                                      {"w=--5", "usage"},
                                                      {"w=0x10", "usage"},
                                                      {"w==1+1", "usage"}};
  for (const auto& [definition, slug] : rows) {
    CAPTURE(definition);
    const Loaded loaded = load_with(kWide, {{definition}, {}});
    REQUIRE(loaded.errors.size() == 1);
    CHECK(loaded.errors[0].slug == slug);
    CHECK(exit_code(loaded.errors[0]) == 2);
    CHECK(loaded.errors[0].line == 0);
  }
}

TEST_CASE("mistakes in a variable that nothing uses are told") {
  const Loaded loaded = load(kBase + "let: {a: '=1/0'}\n");
  REQUIRE(loaded.errors.size() == 1);
  CHECK(loaded.errors[0].slug == "non-finite");
  CHECK(exit_code(loaded.errors[0]) == 3);
}

}  // namespace
}  // namespace patchlight::test
