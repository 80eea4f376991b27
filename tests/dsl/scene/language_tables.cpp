// The tables of the language are complete enough to make a schema and a reference from.
#include "dsl/scene/language_tables.h"

#include "dsl/language/values.h"
#include "dsl/report/diagnostics.h"
#include "dsl/report/limits.h"
#include "dsl/shapes/object_keys.h"
#include "dsl/shapes/shapes.h"
#include "tests/folder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>

namespace patchlight::test {
namespace {

TEST_CASE("every key is described, and no table has one twice") {
  for (const KeyTable* table : language_tables()) {
    CAPTURE(std::string(table->name));
    CHECK(table->rows.size() <= kKeysMax);
    std::set<std::string_view> keys;
    for (const KeyRow& row : table->rows) {
      CAPTURE(std::string(row.key));
      CHECK(keys.insert(row.key).second);
      CHECK(row.description.ends_with('.'));
      CHECK(row.low <= row.high);
      CHECK((row.type != ValueType::kChoice || !row.choices.empty()));
    }
  }
}

TEST_CASE("rules speak of keys that their table has") {
  for (const KeyTable* table : language_tables())
    for (const KeyRule& rule : table->rules) {
      CAPTURE(std::string(rule.text));
      for (const std::string_view words : {rule.keys, rule.others})
        for (const std::string& word : split_words(words)) {
          CAPTURE(word);
          CHECK(row_of(*table, word).key == word);
        }
      CHECK((rule.kind == RuleKind::kOneOf) == rule.others.empty());
    }
}

// The reference without blanks behind commas.
std::string read_reference() {
  std::string text = testing::read_bytes(PATCHLIGHT_SOURCE_DIR "/dsl/README.md");
  for (size_t at = 0; (at = text.find(", ", at)) != std::string::npos;) text.erase(at + 1, 1);
  return text;
}

// What stands below a heading, up to the next one; empty where there is none.
std::string section_of(const std::string& text, const std::string& heading) {
  const size_t begin = text.find("\n" + heading + "\n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find("\n#", begin + 1) - begin);
}

// The sections that tell of a table.
std::string sections_of(const std::string& text, const std::string& table) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> sections = {
      {"scene", {"## Scene"}},
      {"include", {"## Includes"}},
      {"material", {"## Material"}},
      {"object", {"## Object", "### polygon", "### mesh"}},
      {"transform", {"## Object"}},
      {"rotate", {"## Object"}},
      {"grid", {"### grid", "### quad"}},
      {"room", {"### room", "### box"}},
      {"walls", {"### room", "### box"}},
      {"sky", {"## Sky and sun"}},
      {"sun", {"## Sky and sun"}},
      {"sun_direction", {"## Sky and sun"}},
      {"camera", {"## Camera"}},
      {"solver", {"## Solver and output"}},
      {"output", {"## Solver and output"}},
      {"expect", {"## Expectations"}},
  };
  std::string found;
  for (const auto& [name, headings] : sections)
    if (name == table)
      for (const std::string& heading : headings) found += section_of(text, heading);
  return found.empty() ? section_of(text, "### " + table) : found;
}

// A fallback as the reference has it: 0 1 0 is [0,1,0].
std::string written(std::string fallback) {
  if (fallback.find(' ') == std::string::npos) return fallback;
  std::replace(fallback.begin(), fallback.end(), ' ', ',');
  return "[" + fallback + "]";
}

TEST_CASE("the reference names every key with its default, in the section of its table") {
  const std::string text = read_reference();
  for (const KeyTable* table : language_tables()) {
    CAPTURE(table->name);
    const std::string sections = sections_of(text, std::string(table->name));
    CHECK(!sections.empty());
    for (const KeyRow& row : table->rows) {
      const std::string key(row.key);
      CAPTURE(key);
      const bool is_shape = table == &object_keys() && !section_of(text, "### " + key).empty();
      CHECK((is_shape || sections.find("`" + key + "`") != std::string::npos));
      CHECK(sections.find(written(std::string(row.fallback))) != std::string::npos);
    }
  }
}

TEST_CASE("the reference names every limit, with its number") {
  const std::string section = section_of(read_reference(), "## Limits");
  for (const LimitRow& row : kLimitRows) {
    CAPTURE(row.flag);
    CHECK(section.find("`" + std::string(row.flag) + "`") != std::string::npos);
  }
}

TEST_CASE("the reference names every slug that has an exit code of its own") {
  const std::string section = section_of(read_reference(), "## Messages");
  for (const SlugExit& row : slug_exits()) {
    CAPTURE(row.slug);
    CHECK(section.find("`" + std::string(row.slug) + "`") != std::string::npos);
  }
}

TEST_CASE("tables that maps and lists name exist") {
  std::set<std::string_view> names;
  for (const KeyTable* table : language_tables()) CHECK(names.insert(table->name).second);
  for (const KeyTable* table : language_tables())
    for (const KeyRow& row : table->rows) {
      const bool names_table =
          row.type == ValueType::kMap || row.type == ValueType::kList || row.type == ValueType::kIncludes;
      if (!names_table || row.choices.empty() || row.choices == "*" || row.choices == "*text") continue;
      CAPTURE(std::string(row.key));
      CHECK(names.contains(row.choices.substr(row.choices.starts_with('*') ? 1 : 0)));
    }
}

}  // namespace
}  // namespace patchlight::test
