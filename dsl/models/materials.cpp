// The map `materials` to a table.
#include "dsl/models/materials.h"

#include "dsl/language/values.h"
#include "dsl/report/text.h"

#include <fmt/format.h>

#include <cmath>

namespace patchlight {
namespace {

constexpr double kStefanBoltzmann = 5.670374419e-8;  // W/(m2 K4), CODATA 2018

// Of a grey surface, W/m2.
double find_exitance(const MapValues& material) {
  if (!has(material, "temperature")) return 0;
  const double squared = std::pow(value_of(material, "temperature").number[0], 2);
  return value_of(material, "emissivity").number[0] * kStefanBoltzmann * squared * squared;
}

}  // namespace

void read_materials(const Context& context, uint32_t node, MaterialTable& materials) {
  const Tree& tree = context.tree;
  for (uint32_t key = tree.nodes[node].first; key != kNone;) {
    const uint32_t value = tree.nodes[key].next;
    const std::string name(text_of(tree, key));
    if (!is_name(name))
      add_error(context.messages, place_of(tree, key), "bad-name",
                fmt::format("a material's name begins with a letter or _ and goes on with letters, digits, _ "
                            ". or -; got '{}'",
                            escape_text(name)));
    const MapValues map = read_map(context, value, kMaterialKeys);
    const bool is_heat = has(map, "emissivity");
    const DVec3 reflectance =
        is_heat ? DVec3(1 - value_of(map, "emissivity").number[0]) : vec3_of(value_of(map, "reflectance"));
    if (map.good && std::max({reflectance.r, reflectance.g, reflectance.b}) == 1)
      add_warning(context.messages,
                  place_of(tree, value_of(map, is_heat ? "emissivity" : "reflectance").node),
                  "reflectance-one",
                  is_heat ? "an emissivity of 0 keeps all heat: in a closed room the passes never converge"
                          : "a reflectance of 1 keeps all light: in a closed room the passes never converge");
    // A material that is wrong still counts as known: its users are not to be reported too.
    const auto [row, is_new] =
        materials.row_of.emplace(context.prefix + name, static_cast<uint32_t>(materials.size()));
    if (!is_new)
      add_error(context.messages, place_of(tree, key), "duplicate-id",
                fmt::format("the material '{}' is taken: first defined at {}", escape_text(row->first),
                            place_text(context.messages, place_of(tree, materials.node[row->second]),
                                       place_of(tree, key))));
    materials.name.push_back(context.prefix + name);
    materials.reflectance.push_back(reflectance);
    const bool by_power = has(map, "power");
    materials.emission.push_back(is_heat ? DVec3(find_exitance(map))
                                         : vec3_of(value_of(map, by_power ? "power" : "emission")));
    materials.by_power.push_back(by_power);
    materials.is_heat.push_back(is_heat);
    materials.node.push_back(key);
    materials.used.push_back(0);
    key = tree.nodes[value].next;
  }
  materials.named_count = materials.size();
}

uint32_t find_material(const Context& context, uint32_t node, MaterialTable& materials) {
  std::string name;
  if (!read_text(context, node, name)) return kNone;
  for (const std::string& full : {context.prefix + name, name})
    if (const auto row = materials.row_of.find(full); row != materials.row_of.end()) {
      materials.used[row->second] = 1;
      return row->second;
    }
  std::string message = fmt::format("no material '{}'", escape_text(name));
  if (wants_errors(context.messages)) {
    const std::vector<std::string> names(
        materials.name.begin(), materials.name.begin() + static_cast<ptrdiff_t>(materials.named_count));
    const std::string near = did_you_mean(name, names);
    if (!near.empty()) message += fmt::format("; did you mean '{}'?", escape_text(near));
    std::string known;
    for (size_t k = 0; k < std::min<size_t>(names.size(), 12); ++k)
      known += (k ? ", " : "") + escape_text(names[k]);
    message += names.empty() ? "; the scene has no materials"
                             : fmt::format("{} known: {}", near.empty() ? ";" : "", known);
    if (names.size() > 12) message += ", ...";
  }
  add_error(context.messages, place_of(context.tree, node), "unknown-material", std::move(message));
  return kNone;
}

}  // namespace patchlight
