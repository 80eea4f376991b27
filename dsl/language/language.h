// The language as tables: which keys each map has, what their values are, and what they mean.
// The reader, the messages and the JSON Schema all come from these rows.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace patchlight {

enum class ValueType : uint8_t {
  kText,           // any text
  kName,           // a text that matches [A-Za-z_][A-Za-z0-9_.-]*
  kChoice,         // one of the words in `choices`
  kBoolean,        // true or false
  kNumber,         // a finite number
  kInteger,        // a whole number
  kVersion,        // a whole number that is written out, not computed
  kVec2,           // [a, b], each within low..high
  kIntegers2,      // [a, b], whole numbers within low..high
  kVec3,           // [x, y, z], each within low..high
  kVec3OrMap,      // [x, y, z], or a map of the table `choices`
  kRgb,            // a number or [r, g, b], each within low..high
  kList,           // a list of maps of the table `choices`
  kMap,            // a map: `choices` names the table of its keys, or of its values
  kIncludes,       // a list of paths, or of maps of the table `choices`
  kChoices,        // a list of words out of `choices`
  kIntegers,       // a list of whole numbers within low..high, one at least
  kCorners,        // a list of three corners [x, y, z] or more
  kRings,          // a list of such lists
  kScale,          // a number or [x, y, z]
  kAxis,           // one of the words in `choices`, or [x, y, z]
  kNumberOrWord,   // a number within low..high, or the word in `choices`
  kIntegerOrVec3,  // a whole number within low..high, or three of them
};

constexpr double kAnyNumber = std::numeric_limits<double>::max();
constexpr double kAboveZero = std::numeric_limits<double>::denorm_min();
constexpr double kAnyInteger = 4e18;  // no limit but that of the type

// One key of one map.
struct KeyRow {
  std::string_view key;
  ValueType type = ValueType::kText;
  bool required = false;
  std::string_view fallback;  // the value when the key is absent, as it would be written; empty: none
  double low = -kAnyNumber;   // least and largest value
  double high = kAnyNumber;
  std::string_view slug;     // of the error beyond them, and of a wrong choice
  std::string_view choices;  // words: a|b|c; maps and lists: the name of their (items') table; *NAME: a map
                             // of free names to such maps, *: of free names to numbers, *text: to texts
  std::string_view description;
};

enum class RuleKind : uint8_t {
  kExcludes,  // none of `keys` goes with any of `others`; told at the latter
  kNeeds,     // each of `keys` wants all of `others` beside it; told at the former
  kOneOf,     // one of `keys` at least must be there; told at the map
};

// What holds between keys of one map: a|b|c each. `text` is the message, {} in it the name of the table.
struct KeyRule {
  RuleKind kind;
  std::string_view keys, others;
  std::string_view slug, text;
};

// One kind of map.
struct KeyTable {
  std::string_view name;
  std::span<const KeyRow> rows;
  std::span<const KeyRule> rules = {};
};

constexpr int64_t kLanguageVersion = 1;
constexpr size_t kKeysMax = 40;  // rows of the largest table

extern const KeyTable kSceneKeys;
extern const KeyTable kIncludeKeys;    // of one entry of `include`
extern const KeyTable kTransformKeys;  // of one step of `transform`
extern const KeyTable kRotateKeys;
extern const KeyTable kExpectKeys;  // of one entry of `expect`
extern const KeyTable kMaterialKeys;
extern const KeyTable kSkyKeys;
extern const KeyTable kSunKeys;
extern const KeyTable kSunDirectionKeys;  // of its `direction`, where that is a map
extern const KeyTable kSolverKeys;
extern const KeyTable kOutputKeys;

}  // namespace patchlight
