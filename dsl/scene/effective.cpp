// The settings that hold, each with where it comes from.
#include "dsl/scene/effective.h"

#include "dsl/language/expression.h"
#include "dsl/language/variables.h"
#include "dsl/report/text.h"
#include "dsl/scene/cameras.h"
#include "dsl/scene/language_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr std::string_view kBuiltIn = "built-in";
constexpr std::string_view kAutomatic = "automatic";

void add_setting(SettingTable& settings, std::string path, std::string value, std::string origin) {
  settings.path.push_back(std::move(path));
  settings.value.push_back(std::move(value));
  settings.origin.push_back(std::move(origin));
}

std::string origin_of(const Context& context, uint32_t node) {
  const Place place = place_of(context.tree, node);
  const SourceFile& file = context.messages.files[place.file];
  std::string origin = escape_text(file.name, 200);
  if (!file.command_line) origin += fmt::format(":{}:{}", place.line, place.column);
  const std::string_view text = text_of(context.tree, node);
  if (is_expression(text)) origin += fmt::format(" ({})", escape_text(text));
  return origin;
}

std::string list_text(const double* numbers, size_t count) {
  std::string text;
  for (size_t k = 0; k < count; ++k) text += (k > 0 ? ", " : "") + number_text(numbers[k]);
  return "[" + text + "]";
}

// A list of whole numbers that was read before.
std::string integers_text(const Context& context, uint32_t list) {
  std::vector<double> numbers;
  for (uint32_t child = context.tree.nodes[list].first; child != kNone;
       child = context.tree.nodes[child].next) {
    int64_t number = 0;
    read_integer(context, child, number);
    numbers.push_back(static_cast<double>(number));
  }
  return list_text(numbers.data(), numbers.size());
}

std::string word_or_number_text(const Context& context, uint32_t node, const KeyRow& row) {
  const std::string_view text = text_of(context.tree, node);
  if (text == row.choices) return std::string(text);
  double number = 0;
  read_number(context, node, number);
  return number_text(number);
}

// "[0, 1, 0]", or "{azimuth: 150, elevation: 40}".
std::string vector_or_map_text(const Context& context, uint32_t node, const KeyRow& row) {
  if (context.tree.nodes[node].kind != NodeKind::kMap) {
    double number[3] = {0, 0, 0};
    return read_three(context, node, "expected-vec3", number) ? list_text(number, 3) : std::string();
  }
  const auto tables = language_tables();
  const KeyTable* table =
      *std::find_if(tables.begin(), tables.end(), [&](const KeyTable* t) { return t->name == row.choices; });
  const MapValues map = read_map(context, node, *table);
  std::string text;
  for (const KeyRow& key : table->rows)
    if (has(map, key.key))
      text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", key.key,
                          number_text(value_of(map, key.key).number[0]));
  return fmt::format("{{{}}}", text);
}

// The value of a row as a file would have it; empty for what is a table of its own.
std::string value_text(const Context& context, const KeyRow& row, const Value& value) {
  const bool given = value.node != kNone;
  const double integers[2] = {static_cast<double>(value.integer[0]), static_cast<double>(value.integer[1])};
  if (!given && row.fallback.empty()) return std::string(kAutomatic);
  switch (row.type) {
    case ValueType::kInteger:
    case ValueType::kVersion:
      return fmt::format("{}", value.integer[0]);
    case ValueType::kNumber:
      return number_text(value.number[0]);
    case ValueType::kIntegers2:
      return list_text(integers, 2);
    case ValueType::kVec3:
      return list_text(value.number, 3);
    case ValueType::kRgb:
      return value.number[0] == value.number[1] && value.number[1] == value.number[2]
                 ? number_text(value.number[0])
                 : list_text(value.number, 3);
    case ValueType::kVec3OrMap:
      return given ? vector_or_map_text(context, value.node, row) : std::string(row.fallback);
    case ValueType::kIntegers:
      return given ? integers_text(context, value.node) : std::string(row.fallback);
    case ValueType::kNumberOrWord:
      return given ? word_or_number_text(context, value.node, row) : std::string(row.fallback);
    case ValueType::kText:
    case ValueType::kName:
    case ValueType::kChoice:
      return given ? escape_text(text_of(context.tree, value.node), 200) : std::string(row.fallback);
    default:
      return {};
  }
}

void add_row(const Context& context, const std::string& prefix, const MapValues& map, const KeyRow& row,
             SettingTable& settings) {
  const Value& value = value_of(map, row.key);
  std::string text = value_text(context, row, value);
  if (text.empty()) return;
  add_setting(settings, prefix + std::string(row.key), std::move(text),
              value.node == kNone ? std::string(kBuiltIn) : origin_of(context, value.node));
}

// All rows of the map at a node; the table's fallbacks where there is none.
void add_map(const Context& context, const std::string& prefix, uint32_t node, const KeyTable& table,
             SettingTable& settings) {
  const MapValues map = node == kNone ? default_values(table) : read_map(context, node, table);
  for (const KeyRow& row : table.rows)
    if (row.key != "name") add_row(context, prefix, map, row, settings);
}

// Rows of a map that are given or have a fallback: of the others none is chosen automatically.
void add_given(const Context& context, const std::string& prefix, uint32_t node, const KeyTable& table,
               SettingTable& settings) {
  const MapValues map = read_map(context, node, table);
  for (const KeyRow& row : table.rows)
    if (has(map, row.key) || !row.fallback.empty()) add_row(context, prefix, map, row, settings);
}

void add_variables(const Context& context, SettingTable& settings) {
  const VariableTable& variables = *context.variables;
  for (size_t k = 0; k < variables.size(); ++k)
    add_setting(
        settings, "let." + escape_text(variables.name[k]), number_text(variables.value[k]),
        variables.definition[k].empty() ? origin_of(context, variables.node[k]) : variables.definition[k]);
}

// The camera that was fitted to the scene, in the file's units.
void add_fitted_camera(const Scene& scene, SettingTable& settings) {
  const Camera& camera = scene.cameras[0];
  const std::string origin = "fitted to the scene";
  const auto point_text = [](DVec3 p) { return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", p.x, p.y, p.z); };
  const auto in_file = [&](DVec3 p) { return scene.origin + p * scene.units_per_length; };
  add_setting(settings, "camera.eye", point_text(in_file(camera.eye)), origin);
  add_setting(settings, "camera.target", point_text(in_file(camera.target)), origin);
  add_setting(settings, "camera.up", point_text(camera.up), origin);
  add_setting(settings, "camera.fov", number_text(camera.fov_degrees), origin);
  add_setting(settings, "camera.size", fmt::format("[{}, {}]", camera.width, camera.height),
              std::string(kBuiltIn));
  add_setting(settings, "camera.projection", std::string(camera.projection->name), std::string(kBuiltIn));
}

}  // namespace

SettingTable list_settings(const Context& context, const MapValues& map, const Scene& scene) {
  SettingTable settings;
  const Tree& tree = context.tree;
  if (has(map, "title")) add_row(context, "", map, row_of(kSceneKeys, "title"), settings);
  add_row(context, "", map, row_of(kSceneKeys, "units"), settings);
  add_variables(context, settings);
  for (const auto& [key, table] : {std::pair{"sky", &kSkyKeys}, {"sun", &kSunKeys}})
    if (has(map, key)) add_given(context, std::string(key) + ".", value_of(map, key).node, *table, settings);
  if (has(map, "camera")) {
    add_map(context, "camera.", value_of(map, "camera").node, camera_keys(), settings);
  } else if (has(map, "cameras") && tree.nodes[value_of(map, "cameras").node].count > 0) {
    uint32_t child = tree.nodes[value_of(map, "cameras").node].first;
    for (size_t k = 0; child != kNone; child = tree.nodes[child].next, ++k) {
      const std::string& name = scene.cameras[k].name;
      add_map(context, name.empty() ? "camera." : fmt::format("cameras.{}.", name), child, camera_keys(),
              settings);
    }
  } else {
    add_fitted_camera(scene, settings);
  }
  add_map(context, "solver.", value_of(map, "solver").node, kSolverKeys, settings);
  add_map(context, "output.", value_of(map, "output").node, kOutputKeys, settings);
  return settings;
}

}  // namespace patchlight
