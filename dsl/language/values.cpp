// Maps of the tree to values, by a table of keys.
#include "dsl/language/values.h"

#include "dsl/language/expression.h"
#include "dsl/report/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

namespace patchlight {
namespace {

void report(const Context& context, uint32_t node, std::string_view slug, std::string message) {
  add_error(context.messages, place_of(context.tree, node), slug, std::move(message));
}

// Takes the first of the words a|b|c off.
std::string_view take_word(std::string_view& words) {
  const std::string_view word = words.substr(0, words.find('|'));
  words.remove_prefix(std::min(word.size() + 1, words.size()));
  return word;
}

// Is any of the words a key of the map? `first` is the value of the first that is.
bool has_any(const MapValues& map, std::string_view words, uint32_t& first) {
  while (!words.empty())
    if ((first = value_of(map, take_word(words)).node) != kNone) return true;
  return false;
}

bool has_all(const MapValues& map, std::string_view words) {
  while (!words.empty())
    if (!has(map, take_word(words))) return false;
  return true;
}

// Reports the first rule of the table that the map breaks.
bool check_rules(const Context& context, const MapValues& map) {
  for (const KeyRule& rule : map.table->rules) {
    uint32_t first = kNone, other = kNone;
    const bool any = has_any(map, rule.keys, first);
    uint32_t place = kNone;
    if (rule.kind == RuleKind::kExcludes && any && has_any(map, rule.others, other)) place = other;
    if (rule.kind == RuleKind::kNeeds && any && !has_all(map, rule.others)) place = first;
    if (rule.kind == RuleKind::kOneOf && !any) place = map.node;
    if (place == kNone) continue;
    report(context, place, rule.slug, fmt::format(fmt::runtime(rule.text), map.table->name));
    return false;
  }
  return true;
}

const KeyRow* find_row(const KeyTable& table, std::string_view key) {
  for (const KeyRow& row : table.rows)
    if (row.key == key) return &row;
  return nullptr;
}

void report_unknown_key(const Context& context, uint32_t key, const KeyTable& table) {
  if (!wants_errors(context.messages)) return add_error(context.messages, {}, "unknown-key", {});
  const std::string_view word = text_of(context.tree, key);
  std::vector<std::string> known;
  std::string list;
  for (const KeyRow& row : table.rows) {
    known.emplace_back(row.key);
    list += (list.empty() ? "" : ", ") + std::string(row.key);
  }
  std::string message = fmt::format("unknown key '{}' in {}", escape_text(word), table.name);
  std::string lower(word.substr(0, 64));
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (const std::string near = did_you_mean(word, known); near.empty())
    message += "; known: " + list;
  else if (near == lower)
    message += fmt::format("; keys are lower case: '{}'", near);
  else
    message += fmt::format("; did you mean '{}'?", near);
  report(context, key, "unknown-key", std::move(message));
}

// "within 0..1", "above 0", "0 or more": what a message says of a row's range.
std::string range_text(const KeyRow& row) {
  const bool open_above = row.high == kAnyNumber || row.high == kAnyInteger;
  if (row.low == kAboveZero)
    return open_above ? "above 0" : fmt::format("above 0 and at most {}", number_text(row.high));
  if (open_above) return fmt::format("{} or more", number_text(row.low));
  return fmt::format("within {}..{}", number_text(row.low), number_text(row.high));
}

bool check_range(const Context& context, uint32_t node, const KeyRow& row, double number) {
  if (number >= row.low && number <= row.high) return true;
  std::string message = fmt::format("'{}' must be {}, got {}", row.key, range_text(row), number_text(number));
  if (row.slug == "reflectance-range" && number >= 2 && number <= 255)
    message += fmt::format("; of a scale 0..255 this is {:.2f}", number / 255);
  report(context, node, row.slug, std::move(message));
  return false;
}

// Numbers of a list, each with its own place, against the row's range.
bool check_ranges(const Context& context, uint32_t list, const KeyRow& row, const double* numbers) {
  bool good = true;
  size_t k = 0;
  for (uint32_t child = context.tree.nodes[list].first; child != kNone;
       child = context.tree.nodes[child].next)
    good = check_range(context, child, row, numbers[k++]) && good;
  return good;
}

bool read_boolean(const Context& context, uint32_t node, int64_t& value) {
  if (report_null(context, node, "true or false")) return false;
  const std::string_view text = text_of(context.tree, node);
  const bool plain = !context.tree.nodes[node].quoted;
  if (plain && (text == "true" || text == "false")) {
    value = text == "true";
    return true;
  }
  report(context, node, "expected-boolean",
         fmt::format("expected true or false, got {}", describe(context.tree, node)));
  return false;
}

bool read_choice(const Context& context, uint32_t node, const KeyRow& row, int64_t& value) {
  std::string text;
  if (!read_text(context, node, text)) return false;
  const std::vector<std::string> known = split_words(row.choices);
  for (size_t k = 0; k < known.size(); ++k)
    if (known[k] == text) {
      value = static_cast<int64_t>(k);
      return true;
    }
  const std::string near = did_you_mean(text, known);
  report(context, node, row.slug,
         fmt::format("'{}' must be one of {}; got '{}'{}", row.key, fmt::join(known, ", "), escape_text(text),
                     near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
  return false;
}

// The whole file is read by its version, so it cannot depend on what stands there.
bool read_written_integer(const Context& context, uint32_t node, const KeyRow& row, Value& value) {
  if (is_expression(text_of(context.tree, node))) {
    report(
        context, node, "expected-integer",
        fmt::format("'{}' is a number that is written out; got {}", row.key, describe(context.tree, node)));
    return false;
  }
  return read_integer(context, node, value.integer[0]) &&
         check_range(context, node, row, static_cast<double>(value.integer[0]));
}

bool read_integers2(const Context& context, uint32_t node, const KeyRow& row, Value& value) {
  const Node& list = context.tree.nodes[node];
  if (list.kind != NodeKind::kList || list.count != 2) return read_two(context, node, value.number);
  const uint32_t second = context.tree.nodes[list.first].next;
  if (!read_integer(context, list.first, value.integer[0]) ||
      !read_integer(context, second, value.integer[1]))
    return false;
  const double numbers[2] = {static_cast<double>(value.integer[0]), static_cast<double>(value.integer[1])};
  return check_ranges(context, node, row, numbers);
}

bool read_rgb(const Context& context, uint32_t node, const KeyRow& row, Value& value) {
  const Node& source = context.tree.nodes[node];
  if (source.kind == NodeKind::kList)
    return read_three(context, node, "expected-rgb", value.number) &&
           check_ranges(context, node, row, value.number);
  // A word, or #f0f0f0, is more likely a colour's name than a mistyped number.
  const std::string_view text = text_of(context.tree, node);
  const bool word = source.kind == NodeKind::kMap ||
                    (source.kind == NodeKind::kScalar && !is_expression(text) &&
                     (text.starts_with('#') || text.find_first_of("0123456789.") == std::string_view::npos));
  if (word) return read_three(context, node, "expected-rgb", value.number);
  if (!read_number(context, node, value.number[0])) return false;
  value.number[1] = value.number[2] = value.number[0];
  return check_range(context, node, row, value.number[0]);
}

bool read_kind(const Context& context, uint32_t node, const KeyRow& row, NodeKind kind) {
  const bool list = kind == NodeKind::kList;
  const std::string what = fmt::format("a {} for '{}'", list ? "list" : "map", row.key);
  if (report_null(context, node, what)) return false;
  if (context.tree.nodes[node].kind == kind) return true;
  report(context, node, list ? "expected-list" : "expected-map",
         fmt::format("expected {}, got {}", what, describe(context.tree, node)));
  return false;
}

bool read_name(const Context& context, uint32_t node, const KeyRow& row) {
  if (report_null(context, node, "a name")) return false;
  if (context.tree.nodes[node].kind == NodeKind::kScalar && is_name(text_of(context.tree, node))) return true;
  report(context, node, row.slug,
         fmt::format("'{}' begins with a letter or _ and goes on with letters, digits, _ . or -; got {}",
                     row.key, describe(context.tree, node)));
  return false;
}

// The table's fallback ("0 1 0") as numbers, for keys that are absent.
void set_fallback(const KeyRow& row, Value& value) {
  if (row.type == ValueType::kBoolean) value.integer[0] = row.fallback == "true";
  const char* at = row.fallback.data();
  const char* end = at + row.fallback.size();
  int count = 0;
  for (; count < 3 && at < end; ++count) {
    const auto [next, error] = std::from_chars(at, end, value.number[count]);
    if (error != std::errc{}) return;
    at = next < end ? next + 1 : end;
  }
  if (row.type == ValueType::kRgb && count == 1) value.number[1] = value.number[2] = value.number[0];
  for (int k = 0; k < 2; ++k) value.integer[k] = static_cast<int64_t>(value.number[k]);
}

}  // namespace

bool read_text(const Context& context, uint32_t node, std::string& text) {
  if (report_null(context, node, "a text")) return false;
  if (context.tree.nodes[node].kind != NodeKind::kScalar) {
    report(context, node, "expected-text",
           fmt::format("expected a text, got {}", describe(context.tree, node)));
    return false;
  }
  text = text_of(context.tree, node);
  for (size_t k = 0; k < text.size(); ++k) {
    const auto byte = [&](size_t i) { return i < text.size() ? static_cast<uint8_t>(text[i]) : uint8_t{0}; };
    const bool second_set = byte(k) == 0xc2 && byte(k + 1) >= 0x80 && byte(k + 1) < 0xa0;  // U+0080 to U+009F
    if (byte(k) >= 0x20 && byte(k) != 0x7f && !second_set) continue;
    report(context, node, "control-character",
           byte(k) == '\n' ? fmt::format("a text of one line is expected, got '{}'", escape_text(text))
                           : fmt::format("control character {:#04x} in '{}'; take it out",
                                         byte(second_set ? k + 1 : k), escape_text(text)));
    return false;
  }
  return true;
}

bool read_value(const Context& context, uint32_t node, const KeyRow& row, Value& value) {
  value.node = node;
  switch (row.type) {
    case ValueType::kText: {
      std::string text;
      return read_text(context, node, text);
    }
    case ValueType::kName:
      return read_name(context, node, row);
    case ValueType::kChoice:
      return read_choice(context, node, row, value.integer[0]);
    case ValueType::kBoolean:
      return read_boolean(context, node, value.integer[0]);
    case ValueType::kNumber:
      return read_number(context, node, value.number[0]) && check_range(context, node, row, value.number[0]);
    case ValueType::kInteger:
      return read_integer(context, node, value.integer[0]) &&
             check_range(context, node, row, static_cast<double>(value.integer[0]));
    case ValueType::kVec2:
      return read_two(context, node, value.number) && check_ranges(context, node, row, value.number);
    case ValueType::kIntegers2:
      return read_integers2(context, node, row, value);
    case ValueType::kVec3:
      return read_three(context, node, "expected-vec3", value.number) &&
             check_ranges(context, node, row, value.number);
    case ValueType::kRgb:
      return read_rgb(context, node, row, value);
    case ValueType::kVersion:
      return read_written_integer(context, node, row, value);
    case ValueType::kList:
    case ValueType::kIncludes:
    case ValueType::kChoices:
    case ValueType::kIntegers:
    case ValueType::kRings:
      return read_kind(context, node, row, NodeKind::kList);
    case ValueType::kMap:
      return read_kind(context, node, row, NodeKind::kMap);
    case ValueType::kCorners:
    case ValueType::kScale:
    case ValueType::kAxis:
    case ValueType::kVec3OrMap:
    case ValueType::kNumberOrWord:
    case ValueType::kIntegerOrVec3:
      return !report_null(context, node, fmt::format("a value for '{}'", row.key));
  }
  return false;
}

MapValues read_map(const Context& context, uint32_t node, const KeyTable& table) {
  assert(table.rows.size() <= kKeysMax);
  MapValues map;
  map.table = &table;
  map.node = node;
  const Node& source = context.tree.nodes[node];
  if (source.kind != NodeKind::kMap) {
    map.good = false;
    if (!report_null(context, node, fmt::format("a map of the keys of {}", table.name)))
      report(
          context, node, "expected-map",
          fmt::format("expected a map of the keys of {}, got {}", table.name, describe(context.tree, node)));
    return map;
  }
  for (uint32_t key = source.first; key != kNone;) {
    const uint32_t value = context.tree.nodes[key].next;
    if (const KeyRow* row = find_row(table, text_of(context.tree, key))) {
      map.good = read_value(context, value, *row, map.values[static_cast<size_t>(row - table.rows.data())]) &&
                 map.good;
    } else {
      report_unknown_key(context, key, table);
      map.good = false;
    }
    key = context.tree.nodes[value].next;
  }
  for (size_t k = 0; k < table.rows.size(); ++k) {
    if (map.values[k].node != kNone) continue;
    if (table.rows[k].required && map.good) {
      report(context, node, "missing-key",
             fmt::format("{} needs '{}': {}", table.name, table.rows[k].key, table.rows[k].description));
      map.good = false;
    }
    if (!table.rows[k].fallback.empty()) set_fallback(table.rows[k], map.values[k]);
  }
  // A key that is wrong may be the one that a rule asks for.
  if (map.good) map.good = check_rules(context, map);
  return map;
}

void check_version_known(const Context& context, const MapValues& scene_keys) {
  const Value& version = value_of(scene_keys, "patchlight");
  if (version.node == kNone || version.integer[0] <= kLanguageVersion) return;
  report(context, version.node, "version-too-new",
         fmt::format("version {} of the language is newer than this program, which knows version {}",
                     version.integer[0], kLanguageVersion));
}

MapValues default_values(const KeyTable& table) {
  MapValues map;
  map.table = &table;
  for (size_t k = 0; k < table.rows.size(); ++k)
    if (!table.rows[k].fallback.empty()) set_fallback(table.rows[k], map.values[k]);
  return map;
}

const KeyRow& row_of(const KeyTable& table, std::string_view key) {
  const KeyRow* row = find_row(table, key);
  assert(row != nullptr);
  return *row;
}

bool read_direction(const Context& context, const Value& value, DVec3& direction) {
  const DVec3 given = vec3_of(value);
  const double largest_part = std::max({std::abs(given.x), std::abs(given.y), std::abs(given.z)});
  if (largest_part == 0) {
    add_error(context.messages, place_of(context.tree, value.node), "zero-axis",
              "this direction has no length");
    return false;
  }
  direction = glm::normalize(given / largest_part);
  return true;
}

std::vector<std::string> split_words(std::string_view words) {
  std::vector<std::string> list;
  while (!words.empty()) list.emplace_back(take_word(words));
  return list;
}

const Value& value_of(const MapValues& values, std::string_view key) {
  const KeyRow* row = find_row(*values.table, key);
  assert(row != nullptr);
  return values.values[static_cast<size_t>(row - values.table->rows.data())];
}

}  // namespace patchlight
