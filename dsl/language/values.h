// Maps of the tree to values, by a table of keys: unknown and missing keys, types and ranges are checked
// here.
#pragma once

#include "dsl/language/language.h"
#include "dsl/language/number.h"
#include "engine/base/vector.h"

#include <array>
#include <string>
#include <vector>

namespace patchlight {

// The value of one key. Where the key is absent `node` is kNone and the numbers are the table's fallback.
struct Value {
  uint32_t node = kNone;
  double number[3] = {0, 0, 0};  // kNumber, kVec2, kVec3, kRgb
  int64_t integer[2] = {0, 0};   // kInteger, kBoolean, kIntegers2; kChoice: which choice, from 0
};

// The words of a|b|c.
std::vector<std::string> split_words(std::string_view words);

// The values of one map, a row for each row of its table. `good` is false when something was wrong with it:
// an error was reported, and the numbers are not to be used.
struct MapValues {
  const KeyTable* table = nullptr;
  uint32_t node = kNone;
  bool good = true;
  std::array<Value, kKeysMax> values;
};

// Reads a map. Errors: unknown-key (with the nearest known one), missing-key, null-value, expected-..., the
// row's own slug for values beyond its range, and those of the table's rules.
MapValues read_map(const Context& context, uint32_t node, const KeyTable& table);

// The values of a map that is not there: the table's fallbacks.
MapValues default_values(const KeyTable& table);

// The row of a key that the table has.
const KeyRow& row_of(const KeyTable& table, std::string_view key);

// The value of a key that the table has.
const Value& value_of(const MapValues& values, std::string_view key);
inline bool has(const MapValues& values, std::string_view key) { return value_of(values, key).node != kNone; }
inline DVec3 vec3_of(const Value& value) { return DVec3(value.number[0], value.number[1], value.number[2]); }

// Reports version-too-new where a file's keys name a version that this program does not know.
void check_version_known(const Context& context, const MapValues& scene_keys);

// Checks one value against a row; false after an error. For values that stand in lists of their own.
bool read_value(const Context& context, uint32_t node, const KeyRow& row, Value& value);

// A text of one line that becomes part of names or is shown: false after expected-text, null-value or
// control-character.
bool read_text(const Context& context, uint32_t node, std::string& text);

// The unit vector of a key's value; false after zero-axis.
bool read_direction(const Context& context, const Value& value, DVec3& direction);

}  // namespace patchlight
