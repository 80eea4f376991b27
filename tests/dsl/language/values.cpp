// Maps of the tree against tables of keys: types, ranges, defaults and rules, without a scene around them.
#include "dsl/language/values.h"

#include "engine/base/vector.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace patchlight::test {
namespace {

using enum ValueType;
using enum RuleKind;

constexpr KeyRow kRows[] = {
    {"name", kName, true, "", 0, 0, "bad-name", "", "A name."},
    {"share", kNumber, false, "0.5", 0, 1, "out-of-range", "", "A share."},
    {"count", kInteger, false, "3", 1, 10, "out-of-range", "", "How many."},
    {"place", kVec3, false, "1 2 3", -5, 5, "out-of-range", "", "Where."},
    {"colour", kRgb, false, "0.25", 0, 1, "reflectance-range", "", "Which."},
    {"size", kIntegers2, false, "4 3", 1, 100, "out-of-range", "", "How large."},
    {"kind", kChoice, false, "round", 0, 0, "bad-name", "round|square", "Of which kind."},
    {"open", kBoolean, false, "true", 0, 0, "", "", "Is it?"},
    {"left", kNumber, false, "", 0, 9, "out-of-range", "", "One way."},
    {"right", kNumber, false, "", 0, 9, "out-of-range", "", "Another way."},
    {"depth", kNumber, false, "", kAboveZero, 9, "out-of-range", "", "Goes with left."},
};
constexpr KeyRule kRules[] = {
    {kExcludes, "left", "right", "ambiguous-shape", "left or right"},
    {kNeeds, "depth", "left", "missing-key", "depth needs left"},
};
const KeyTable kTable = {"thing", kRows, kRules};

// What reading a map says: the values, or "slug line:column message" of each error.
struct Read {
  Messages messages;
  Tree tree;
  MapValues map;
  std::vector<std::string> errors;
  explicit Read(const std::string& text) {
    messages.files.push_back({"t.yaml", text});
    const uint32_t root = parse_tree(messages, 0, tree);
    REQUIRE(root != kNone);
    map = read_map({tree, messages}, root, kTable);
    for (const Diagnostic& error : messages.errors)
      errors.push_back(fmt::format("{} {}:{} {}", error.slug, error.line, error.column, error.message));
    CHECK(map.good == errors.empty());
  }
};

TEST_CASE("absent keys have the table's defaults") {
  const Read read("{name: a}");
  REQUIRE(read.errors.empty());
  CHECK(value_of(read.map, "share").number[0] == 0.5);
  CHECK(value_of(read.map, "count").integer[0] == 3);
  CHECK(vec3_of(value_of(read.map, "place")) == DVec3(1, 2, 3));
  CHECK(vec3_of(value_of(read.map, "colour")) == DVec3(0.25));
  CHECK(value_of(read.map, "size").integer[1] == 3);
  CHECK(value_of(read.map, "open").integer[0] == 1);
  CHECK(!has(read.map, "share"));
  const MapValues values = default_values(kTable);
  CHECK(value_of(values, "count").integer[0] == 3);
}

TEST_CASE("values are read by the type of their row") {
  const Read read(
      "{name: b.c-d, share: 1e-1, count: '=2*4', place: [-5, 0, 5], colour: [0, 0.5, 1], size: [100, 1], "
      "kind: square, "
      "open: false}");
  REQUIRE(read.errors.empty());
  CHECK(value_of(read.map, "share").number[0] == 0.1);
  CHECK(value_of(read.map, "count").integer[0] == 8);
  CHECK(vec3_of(value_of(read.map, "place")) == DVec3(-5, 0, 5));
  CHECK(vec3_of(value_of(read.map, "colour")) == DVec3(0, 0.5, 1));
  CHECK(value_of(read.map, "size").integer[0] == 100);
  CHECK(value_of(read.map, "kind").integer[0] == 1);
  CHECK(value_of(read.map, "open").integer[0] == 0);
}

TEST_CASE("each mistake is told at its own value, all in one go") {
  const Read read(
      "name: 1\nshare: 1.5\ncount: 2.5\nplace: [0, 6, x]\nsize: [0, 1]\nkind: squre\nopen: yes\nleft: ~\n");
  REQUIRE(read.errors.size() == 8);
  CHECK(read.errors[0].starts_with("bad-name 1:7 'name' begins with a letter"));
  CHECK(read.errors[1] == "out-of-range 2:8 'share' must be within 0..1, got 1.5");
  CHECK(read.errors[2].starts_with("expected-integer 3:8 "));
  CHECK(read.errors[3].starts_with("expected-number 4:15 "));
  CHECK(read.errors[4] == "out-of-range 5:8 'size' must be within 1..100, got 0");
  CHECK(read.errors[5] ==
        "bad-name 6:7 'kind' must be one of round, square; got 'squre'; did you mean 'square'?");
  CHECK(read.errors[6].starts_with("expected-boolean 7:7 "));
  CHECK(read.errors[7].starts_with("null-value 8:"));
}

TEST_CASE("keys that the table has not, or wants, are told") {
  CHECK(Read("{name: a, cuont: 3}").errors ==
        std::vector<std::string>{"unknown-key 1:11 unknown key 'cuont' in thing; did you mean 'count'?"});
  CHECK(Read("{share: 0.1}").errors ==
        std::vector<std::string>{"missing-key 1:1 thing needs 'name': A name."});
  // Where a key is wrong, that may be the one that is missing.
  CHECK(Read("{nmae: a}").errors.size() == 1);
  CHECK(Read("[a]").errors[0].starts_with("expected-map 1:1 "));
}

TEST_CASE("rules between keys are told at the key that breaks them") {
  CHECK(Read("{name: a, left: 1, right: 2}").errors ==
        std::vector<std::string>{"ambiguous-shape 1:27 left or right"});
  CHECK(Read("{name: a, depth: 1}").errors == std::vector<std::string>{"missing-key 1:18 depth needs left"});
  CHECK(Read("{name: a, depth: 1, left: 1}").errors.empty());
  CHECK(Read("{name: a, depth: 0, left: 1}").errors ==
        std::vector<std::string>{"out-of-range 1:18 'depth' must be above 0 and at most 9, got 0"});
}

TEST_CASE("texts are of one line and without control characters") {
  const auto slug = [](const std::string& text) -> std::string {
    Messages messages;
    messages.files.push_back({"t.yaml", text});
    Tree tree;
    const uint32_t root = parse_tree(messages, 0, tree);
    REQUIRE(root != kNone);
    std::string read;
    const bool good = read_text({tree, messages}, root, read);
    CHECK(good == messages.errors.empty());
    return good ? "" : messages.errors[0].slug;
  };
  CHECK(slug("\"caf\\u00e9 \\u20ac\"") == "");
  CHECK(slug("\"a\\nb\"") == "control-character");
  CHECK(slug("\"a\\x85\"") == "control-character");
  CHECK(slug("\"a\\x7f\"") == "control-character");
  CHECK(slug("[a]") == "expected-text");
}

TEST_CASE("words are split at bars") {
  CHECK(split_words("a|bc|d") == std::vector<std::string>{"a", "bc", "d"});
  CHECK(split_words("").empty());
}

}  // namespace
}  // namespace patchlight::test
