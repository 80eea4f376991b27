// The tables of the language are complete enough to make a schema and a reference from.
#include "dsl/language.h"

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

TEST_CASE("tables that maps and lists name exist") {
  std::set<std::string_view> names;
  for (const KeyTable* table : language_tables()) CHECK(names.insert(table->name).second);
  for (const KeyTable* table : language_tables())
    for (const KeyRow& row : table->rows) {
      if (row.type == ValueType::kChoice || row.choices.empty()) continue;
      CAPTURE(std::string(row.key));
      const std::string_view name = row.choices.substr(row.choices.starts_with('*') ? 1 : 0);
      CHECK((name.empty() || names.contains(name)));
    }
}

}  // namespace
}  // namespace patchlight::test
