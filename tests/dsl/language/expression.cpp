// Expressions: their grammar and their values.
#include "dsl/language/expression.h"

#include "dsl/language/let.h"
#include "dsl/language/number.h"
#include "tests/dsl/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight::test {
namespace {

// The value of an expression where w = 6 and h = $w/2, or NaN after an error.
double value_of_text(const std::string& expression) {
  Messages messages;
  messages.files.push_back({"t.yaml", fmt::format("{{let: {{w: 6, h: '=$w/2'}}, x: \"{}\"}}", expression)});
  Tree tree;
  const uint32_t root = parse_tree(messages, 0, tree);
  REQUIRE(root != kNone);
  VariableTable variables;
  const Context context{tree, messages, &variables};
  read_let(context, child_of(tree, root, 1), variables);
  work_out_variables(context, variables);
  double value = 0;
  return read_number(context, child_of(tree, root, 3), value) ? value
                                                              : std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("expressions have the usual order of operators") {
  const std::pair<const char*, double> rows[] = {
      {"=1+2*3", 7},      {"=(1+2)*3", 9},     {"=2^3^2", 512},
      {"=-2^2", -4},      {"=8/4/2", 1},       {"=7-4-2", 1},
      {"=2*-3", -6},      {"=1e3+.5", 1000.5}, {"= 1 + 2 ", 3},
      {"=min(3,1,2)", 1}, {"=max(3,1)", 3},    {"=sin(30)", 0.5},
      {"=cos(60)", 0.5},  {"=tan(45)", 1},     {"=sqrt(16)", 4},
      {"=abs(-3)", 3},    {"=floor(2.7)", 2},  {"=2*pi", 2 * std::numbers::pi},
      {"$w", 6},          {"$h", 3},           {"=$w-0.5*$h", 4.5},
      {"=$w^2", 36},      {"=+5", 5},          {"=2^-1", 0.5},
      {"=--1", 1}};
  for (const auto& [text, expected] : rows) {
    CAPTURE(text);
    CHECK(value_of_text(text) == doctest::Approx(expected).epsilon(1e-14));
  }
}

TEST_CASE("right angles are exact") {
  CHECK(value_of_text("=sin(180)") == 0);
  CHECK(value_of_text("=cos(90)") == 0);
  CHECK(value_of_text("=cos(270)") == 0);
}

TEST_CASE("what is no expression has no value") {
  for (const char* text : {"=", "=1+", "=(1", "=1)", "=1 2", "=foo(1)", "=w", "$", "=$", "$w+1", "=1/0",
                           "=sqrt(-1)", "=sin 30", "=min()", "=1e999", "=2**3", "=$nosuch"}) {
    CAPTURE(text);
    CHECK(std::isnan(value_of_text(text)));
  }
}

}  // namespace
}  // namespace patchlight::test
