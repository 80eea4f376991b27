// Scalars to numbers: what is read, and what is refused.
#include "dsl/language/number.h"

#include "engine/base/vector.h"

#include <doctest/doctest.h>

#include <string>

namespace patchlight::test {
namespace {

// The slug that reading `text` ends with; empty: it is the number in `value`.
std::string read(const std::string& text, double& value, bool integer = false) {
  Messages messages;
  messages.files.push_back({"t.yaml", text});
  Tree tree;
  const uint32_t root = parse_tree(messages, 0, tree);
  REQUIRE(root != kNone);
  const Context context{tree, messages};
  int64_t whole = 0;
  const bool good = integer ? read_integer(context, root, whole) : read_number(context, root, value);
  if (integer) value = static_cast<double>(whole);
  CHECK(good == messages.errors.empty());
  return messages.errors.empty() ? std::string{} : messages.errors[0].slug;
}

TEST_CASE("numbers in every form of YAML 1.2") {
  const std::pair<const char*, double> rows[] = {
      {"0", 0},        {"-0.5", -0.5},    {"+2", 2},     {".5", 0.5},  {"5.", 5},       {"1e3", 1000},
      {"1E-3", 0.001}, {"-1.5e+2", -150}, {"1e-400", 0}, {"0.1", 0.1}, {"1e308", 1e308}};
  for (const auto& [text, expected] : rows) {
    CAPTURE(text);
    double value = -1;
    CHECK(read(text, value) == "");
    CHECK(value == expected);
  }
}

TEST_CASE("numbers near 0 are 0, those too large are refused, however they are written") {
  double value = -1;
  const std::string zeros(400, '0');
  for (const std::string& text :
       std::vector<std::string>{"1e-400", "-1e-99999999999999999999", "0." + zeros + "1", "123.5e-500"}) {
    CAPTURE(text);
    CHECK(read(text, value) == "");
    CHECK(value == 0);
  }
  for (const std::string& text :
       std::vector<std::string>{"1e400", "1" + zeros + "e-5", "0.1e99999999999999999999"}) {
    CAPTURE(text);
    CHECK(read(text, value) == "number-out-of-range");
  }
}

TEST_CASE("what is no number, or not the same one to everybody, is refused") {
  const std::pair<const char*, const char*> rows[] = {
      {"abc", "expected-number"},   {"0x10", "expected-number"},      {"1_000", "expected-number"},
      {"'1'", "expected-number"},   {"1,5", "expected-number"},       {"inf", "expected-number"},
      {"nan", "expected-number"},   {".inf", "non-finite"},           {"-.INF", "non-finite"},
      {".nan", "non-finite"},       {"1e309", "number-out-of-range"}, {"~", "null-value"},
      {"010", "ambiguous-integer"}, {"[1]", "expected-number"},       {"+-1", "expected-number"},
      {"0o17", "expected-number"},  {"true", "expected-number"},      {"1e", "expected-number"},
      {"5%", "expected-number"},    {"--1", "expected-number"}};
  for (const auto& [text, slug] : rows) {
    CAPTURE(text);
    double value = 0;
    CHECK(read(text, value) == slug);
  }
}

TEST_CASE("whole numbers") {
  double value = 0;
  CHECK(read("16", value, true) == "");
  CHECK(value == 16);
  CHECK(read("-3", value, true) == "");
  for (const char* text : {"2.5", "1e3", "16.0", "one", "true"}) {
    CAPTURE(text);
    CHECK(read(text, value, true) == "expected-integer");
  }
  CHECK(read("99999999999999999999", value, true) == "number-out-of-range");
  CHECK(read("007", value, true) == "ambiguous-integer");
}

}  // namespace
}  // namespace patchlight::test
