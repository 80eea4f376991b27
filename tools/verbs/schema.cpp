// The language's tables of keys to a JSON Schema (draft-07): one definition a table, one property a row.
#include "tools/verbs/schema.h"

#include "dsl/language/values.h"
#include "dsl/scene/language_tables.h"
#include "dsl/shapes/shapes.h"
#include "tools/base/files.h"
#include "tools/base/json.h"
#include "tools/verbs/verbs.h"

#include <cmath>
#include <sstream>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Prints the JSON Schema (draft-07) of the scene language, made from the tables that scenes are read by.

Examples:
  patchlight schema > patchlight.schema.json        for editors; in a scene's first line:
  # yaml-language-server: $schema=./patchlight.schema.json
)";

constexpr const char* kNamePattern = "^[A-Za-z_][A-Za-z0-9_.-]*$";

Json reference(std::string_view name) { return {{"$ref", "#/definitions/" + std::string(name)}}; }
Json any_of(Json options) { return {{"anyOf", std::move(options)}}; }

// Whole numbers without a point.
Json number_of(double number) {
  if (number == std::floor(number) && std::abs(number) < 9e18) return static_cast<int64_t>(number);
  return number;
}

Json with_range(Json schema, const KeyRow& row) {
  if (row.low == kAboveZero)
    schema["exclusiveMinimum"] = 0;
  else if (row.low != -kAnyNumber)
    schema["minimum"] = number_of(row.low);
  if (row.high != kAnyNumber && row.high != kAnyInteger) schema["maximum"] = number_of(row.high);
  return schema;
}

// A number or whole number of the row's range, or an expression.
Json numeric(const char* type, const KeyRow& row) {
  return any_of({with_range({{"type", type}}, row), reference("expression")});
}

Json list_of(Json items, size_t low, size_t high = 0) {
  Json schema = {{"type", "array"}, {"items", std::move(items)}};
  if (low > 0) schema["minItems"] = low;
  if (high > 0) schema["maxItems"] = high;
  return schema;
}

Json map_of(Json values) {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", kNamePattern}}},
          {"additionalProperties", std::move(values)}};
}

Json map_schema(std::string_view choices) {
  if (choices == "*") return map_of(any_of({{{"type", "number"}}, reference("expression")}));
  if (choices == "*text") return {{"type", "object"}, {"additionalProperties", reference("text")}};
  if (choices.starts_with('*')) return map_of(reference(choices.substr(1)));
  return reference(choices);
}

Json value_schema(const KeyRow& row) {
  const Json words = {{"enum", split_words(row.choices)}};
  const Json number = numeric("number", row), integer = numeric("integer", row);
  switch (row.type) {
    case ValueType::kText:
      return reference("text");
    case ValueType::kName:
      return {{"type", "string"}, {"pattern", kNamePattern}};
    case ValueType::kChoice:
      return words;
    case ValueType::kBoolean:
      return {{"type", "boolean"}};
    case ValueType::kNumber:
      return number;
    case ValueType::kInteger:
      return integer;
    case ValueType::kVersion:
      return {{"const", kLanguageVersion}};
    case ValueType::kVec2:
      return list_of(number, 2, 2);
    case ValueType::kIntegers2:
      return list_of(integer, 2, 2);
    case ValueType::kVec3:
      return list_of(number, 3, 3);
    case ValueType::kVec3OrMap:
      return any_of({list_of(number, 3, 3), map_schema(row.choices)});
    case ValueType::kRgb:
      return any_of({with_range({{"type", "number"}}, row), reference("expression"), list_of(number, 3, 3)});
    case ValueType::kList:
      return list_of(reference(row.choices), row.low > 0 ? static_cast<size_t>(row.low) : 0);
    case ValueType::kMap:
      return map_schema(row.choices);
    case ValueType::kIncludes:
      return list_of(any_of({reference("text"), reference(row.choices)}), 0);
    case ValueType::kChoices:
      return list_of(words, 0);
    case ValueType::kIntegers:
      return list_of(integer, 1);
    case ValueType::kCorners:
      return reference("corners");
    case ValueType::kRings:
      return list_of(reference("corners"), 0);
    case ValueType::kScale:
      return any_of(
          {{{"type", "number"}, {"not", {{"const", 0}}}}, reference("expression"), reference("vector")});
    case ValueType::kAxis:
      return any_of({words, reference("vector")});
    case ValueType::kNumberOrWord:
      return any_of({words, with_range({{"type", "number"}}, row), reference("expression")});
    case ValueType::kIntegerOrVec3:
      return any_of(
          {with_range({{"type", "integer"}}, row), reference("expression"), list_of(integer, 3, 3)});
  }
  return {};
}

// The fallback as a value: "0 1 0" is a list.
Json fallback_of(const KeyRow& row) {
  if (row.type == ValueType::kBoolean) return row.fallback == "true";
  std::istringstream words{std::string(row.fallback)};
  Json list = Json::array();
  for (double number = 0; words >> number;) list.push_back(number_of(number));
  if (list.empty()) return std::string(row.fallback);
  const Json first = list[0];
  return list.size() == 1 ? first : list;
}

Json property_of(const KeyRow& row) {
  // Beside a $ref nothing else counts, hence allOf.
  Json schema = value_schema(row);
  if (schema.contains("$ref")) schema = {{"allOf", Json::array({schema})}};
  Json property = {{"description", std::string(row.description)}};
  if (!row.fallback.empty()) property["default"] = fallback_of(row);
  property.update(schema);
  return property;
}

Json required_of(std::string_view key) { return {{"required", Json::array({std::string(key)})}}; }

void add_rule(const KeyRule& rule, Json& schema) {
  const std::vector<std::string> keys = split_words(rule.keys), others = split_words(rule.others);
  for (const std::string& key : keys) {
    if (rule.kind == RuleKind::kOneOf) schema["anyOf"].push_back(required_of(key));
    for (const std::string& other : others) {
      if (rule.kind == RuleKind::kExcludes)
        schema["allOf"].push_back({{"not", {{"required", {key, other}}}}});
      if (rule.kind == RuleKind::kNeeds && other != key) schema["dependencies"][key].push_back(other);
    }
  }
}

Json table_schema(const KeyTable& table) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}};
  for (const KeyRow& row : table.rows) schema["properties"][std::string(row.key)] = property_of(row);
  for (const KeyRow& row : table.rows)
    if (row.required) schema["required"].push_back(std::string(row.key));
  for (const KeyRule& rule : table.rules) add_rule(rule, schema);
  return schema;
}

}  // namespace

std::string format_schema() {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "patchlight scene"},
                 {"description", "A scene for patchlight, or a part of one that a scene includes."}};
  schema.update(table_schema(kSceneKeys));
  schema["required"] = Json::array({"patchlight"});
  Json& definitions = schema["definitions"];
  definitions["expression"] = {{"description", "$name, or a text that begins with =: \"=$w/2 - 0.1\"."},
                               {"type", "string"},
                               {"pattern", "^[$=]"}};
  definitions["text"] = {{"type", {"string", "number", "boolean"}}};
  definitions["vector"] = list_of(any_of({{{"type", "number"}}, reference("expression")}), 3, 3);
  definitions["corners"] = list_of(reference("vector"), 3);
  for (const KeyTable* table : language_tables())
    if (table != &kSceneKeys) definitions[std::string(table->name)] = table_schema(*table);
  for (const ShapeRow& shape : shape_rows())
    definitions["object"]["oneOf"].push_back(required_of(shape.name));
  return format_json(schema);
}

void describe_schema(Usage& usage, Options&) { usage.help = kHelp; }

int print_schema(const Options&, Talk&) {
  print_result(format_schema());
  return 0;
}

}  // namespace patchlight
