// The tables of the language are complete enough to make a schema and a reference from.
#include "dsl/language.h"

#include "dsl/values.h"

#include <doctest/doctest.h>

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
