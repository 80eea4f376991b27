// YAML text to the located tree.
#include "dsl/yaml/tree.h"

#include "dsl/report/limits.h"
#include "engine/base/vector.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

namespace patchlight::test {
namespace {

struct Parsed {
  Messages messages;
  Tree tree;
  uint32_t root = kNone;
};

void parse(const std::string& text, Parsed& parsed) {
  parsed.messages.files.push_back({"t.yaml", text});
  parsed.root = parse_tree(parsed.messages, 0, parsed.tree);
}

std::string slug_of(const std::string& text) {
  Parsed parsed;
  parse(text, parsed);
  return parsed.messages.errors.empty() ? std::string{} : parsed.messages.errors[0].slug;
}

TEST_CASE("nodes know their kind, text and place") {
  Parsed parsed;
  parse("a: 1\nbc:\n  - 'x'\n  - {d: ~}\n", parsed);
  REQUIRE(parsed.root != kNone);
  const Tree& tree = parsed.tree;
  CHECK(tree.nodes[parsed.root].kind == NodeKind::kMap);
  CHECK(tree.nodes[parsed.root].count == 4);
  const uint32_t list = child_of(tree, parsed.root, 3);
  CHECK(tree.nodes[list].kind == NodeKind::kList);
  const uint32_t text = child_of(tree, list, 0);
  CHECK(text_of(tree, text) == "x");
  CHECK(tree.nodes[text].quoted);
  CHECK(tree.nodes[text].line == 3);
  CHECK(tree.nodes[text].column == 5);
  const uint32_t empty = child_of(tree, child_of(tree, list, 1), 1);
  CHECK(tree.nodes[empty].kind == NodeKind::kNull);
}

TEST_CASE("an empty value stands at its key") {
  Parsed parsed;
  parse("a: 1\nb:\n\n\nc: 2\n", parsed);
  const uint32_t empty = child_of(parsed.tree, parsed.root, 3);
  CHECK(parsed.tree.nodes[empty].kind == NodeKind::kNull);
  CHECK(parsed.tree.nodes[empty].line == 2);
}

TEST_CASE("an alias stands for the nodes of its anchor, at its own place") {
  Parsed parsed;
  parse("a: &x [1, 2]\nb: *x\n", parsed);
  REQUIRE(parsed.root != kNone);
  const uint32_t alias = child_of(parsed.tree, parsed.root, 3);
  CHECK(parsed.tree.nodes[alias].count == 2);
  CHECK(parsed.tree.nodes[alias].line == 2);
  CHECK(text_of(parsed.tree, child_of(parsed.tree, alias, 1)) == "2");
}

TEST_CASE("aliases cannot grow without end, in number or in depth") {
  CHECK(slug_of("a: &x\n  b: *x\n") == "alias-cycle");
  std::string laughs = "a0: &a0 [1]\n", chain = "c0: &c0 [1]\n";
  for (int k = 1; k < 10; ++k) {
    laughs += fmt::format("a{0}: &a{0} [", k);
    for (int j = 0; j < 10; ++j) laughs += fmt::format("{}*a{}", j ? ", " : "", k - 1);
    laughs += "]\n";
  }
  for (int k = 1; k < 100; ++k) chain += fmt::format("c{0}: &c{0} [*c{1}]\n", k, k - 1);
  CHECK(slug_of(laughs) == "alias-expansion");
  CHECK(slug_of(chain) == "too-deep");
}

TEST_CASE("double keys are found in small and in large maps") {
  CHECK(slug_of("{a: 1, b: 2, a: 3}") == "duplicate-key");
  std::string large;
  for (int k = 0; k < 5000; ++k) large += fmt::format("k{}: 1\n", k);
  CHECK(slug_of(large) == "");
  CHECK(slug_of(large + "k17: 2\n") == "duplicate-key");
}

TEST_CASE("what the language leaves out of YAML is refused") {
  CHECK(slug_of("a: {<<: {b: 1}}") == "merge-key-unsupported");
  CHECK(slug_of("a: !x 1") == "unknown-tag");
  CHECK(slug_of("a: !!float 1") == "");
  CHECK(slug_of("? [1]\n: 2\n") == "key-not-string");
  CHECK(slug_of("a: 1\n---\nb: 2\n") == "multiple-documents");
  CHECK(slug_of("a: *b") == "yaml-undefined-alias");
}

TEST_CASE("what stands in a root of brackets, or behind it, has its own place") {
  const auto place_of_error = [](const std::string& text) {
    Parsed parsed;
    parse(text, parsed);
    if (parsed.messages.errors.empty()) return std::string{};
    const Diagnostic& error = parsed.messages.errors[0];
    return fmt::format("{} {}:{}", error.slug, error.line, error.column);
  };
  Parsed parsed;
  parse("# JSON\n\n  {\"a\": 1,\n \"b\": [2]}\n", parsed);
  REQUIRE(parsed.root != kNone);
  const uint32_t one = child_of(parsed.tree, parsed.root, 1), two = child_of(parsed.tree, parsed.root, 3);
  CHECK(parsed.tree.nodes[parsed.root].column == 3);
  CHECK(parsed.tree.nodes[one].line == 3);
  CHECK(parsed.tree.nodes[one].column == 9);
  CHECK(parsed.tree.nodes[two].line == 4);
  CHECK(parsed.tree.nodes[two].column == 7);
  CHECK(place_of_error("{a: 1, a: 2}") == "duplicate-key 1:8");
  CHECK(place_of_error("{a: 1, b: *c}") == "yaml-undefined-alias 1:11");
  CHECK(place_of_error("[a,\n b: !x c]") == "unknown-tag 2:5");
  CHECK(place_of_error("{a: 1}\n---\nb: 2\n") == "multiple-documents 2:1");
  CHECK(place_of_error("{a: 1}\nb: 2\n") == "yaml-syntax 2:1");
  CHECK(place_of_error("{a: 1} b\n") == "yaml-syntax 1:8");
  CHECK(place_of_error("---\n{a: 1, a: 2}") == "duplicate-key 2:8");
  CHECK(place_of_error("--- {a: 1, a: 2}") == "duplicate-key 1:12");
  CHECK(place_of_error("\n{a: 1, a: 2}") == "duplicate-key 2:8");
  CHECK(place_of_error("\n\n[*a]") == "yaml-undefined-alias 3:2");
  CHECK(place_of_error("{").starts_with("yaml-syntax"));
}

TEST_CASE("64 levels are read, 65 are not") {
  CHECK(slug_of(std::string(Limits{}.nesting, '[') + std::string(Limits{}.nesting, ']')) == "");
  CHECK(slug_of(std::string(Limits{}.nesting + 1, '[') + std::string(Limits{}.nesting + 1, ']')) ==
        "too-deep");
}

}  // namespace
}  // namespace patchlight::test
