// What mesh files say of their materials, to rows of the scene's materials.
#include "dsl/models/mesh_materials.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr size_t kNamesShown = 4;

// "'oak', 'steel' and 3 more"; empty for none.
std::string list_names(const std::vector<std::string>& names) {
  std::string text;
  for (size_t k = 0; k < std::min(names.size(), kNamesShown); ++k)
    text += fmt::format("{}'{}'", k > 0 ? ", " : "", escape_text(names[k]));
  if (names.size() > kNamesShown) text += fmt::format(" and {} more", names.size() - kNamesShown);
  return text;
}

struct Names {
  std::vector<std::string> unknown, limited, all_light, textured, transparent, emitting;
};

// The reflectance of material `row` of the mesh; what is to be said of it goes to `names`.
DRgb reflectance_of(const MeshFile& mesh, size_t row, Names& names) {
  const DRgb fallback(kDefaultReflectance);
  if (row == mesh.table.material.size()) return fallback;
  const std::string& name = mesh.table.material[row];
  const MeshMaterials& defined = mesh.table.defined;
  const auto found = defined.row_of.find(name);
  if (found == defined.row_of.end()) {
    names.unknown.push_back(name);
    return fallback;
  }
  const uint32_t m = found->second;
  if (defined.textured[m]) names.textured.push_back(name);
  if (defined.transparent[m]) names.transparent.push_back(name);
  if (defined.emits[m]) names.emitting.push_back(name);
  if (!defined.has_reflectance[m]) return fallback;
  const DRgb given = defined.reflectance[m], limited = glm::clamp(given, DRgb(0), DRgb(1));
  if (given != limited)
    names.limited.push_back(name);
  else if (std::max({given.r, given.g, given.b}) == 1)
    names.all_light.push_back(name);
  return limited;
}

void warn_of(Messages& messages, const MeshFile& mesh, bool unnamed, const Names& names) {
  const MeshWords& words = mesh.format->words;
  const MeshMaterials& defined = mesh.table.defined;
  const auto place_of_use = [&](const std::string& name) {
    return Place{mesh.file, mesh.table.material_line[mesh.table.material_row.at(name)], 1};
  };
  const auto place_defined = [&](const std::string& name) { return defined.place[defined.row_of.at(name)]; };
  if (unnamed)
    add_warning(messages, {mesh.file, 1, 1}, "unknown-material",
                fmt::format("faces without a material get a reflectance of {}; give the mesh a `material`",
                            kDefaultReflectance));
  if (!names.unknown.empty() && !mesh.table.library_missing)
    add_warning(
        messages, place_of_use(names.unknown[0]), "unknown-material",
        fmt::format("no {} file defines {}: reflectance {}; `materials` or `material` of the mesh can "
                    "say better",
                    words.materials, list_names(names.unknown), kDefaultReflectance));
  if (!names.limited.empty())
    add_warning(
        messages, place_defined(names.limited[0]), "reflectance-range",
        fmt::format("{} is beyond 0..1 in {}: limited", words.reflectance, list_names(names.limited)));
  if (!names.all_light.empty())
    add_warning(messages, place_defined(names.all_light[0]), "reflectance-one",
                fmt::format("{} is 1 in {}: it keeps all light; in a closed room the passes never converge",
                            words.reflectance, list_names(names.all_light)));
  std::string left_out;
  const std::string* first = nullptr;
  const auto add = [&](std::string_view what, const std::vector<std::string>& of) {
    if (of.empty()) return;
    left_out += fmt::format("{}{} of {}", left_out.empty() ? "" : ", ", what, list_names(of));
    if (!first) first = &of[0];
  };
  add("textures", names.textured);
  add("transparency", names.transparent);
  add(fmt::format("light ({})", words.emission), names.emitting);
  if (first)
    add_warning(messages, place_defined(*first), "mesh-simplified",
                fmt::format("only {} is used; left out: {}", words.reflectance, left_out));
}

}  // namespace

bool make_mesh_materials(const Context& context, uint32_t node, const std::vector<uint8_t>& wanted,
                         MeshFile& mesh, MaterialTable& materials) {
  Names names;
  bool unnamed = false;
  for (size_t row = 0; row < wanted.size(); ++row) {
    if (!wanted[row] || mesh.material_row[row] != kNone) continue;
    if (!mesh.materials_read && mesh.format->read_materials) {
      mesh.materials_read = true;
      mesh.good = mesh.format->read_materials(context.messages, mesh.file, mesh.table);
      if (!mesh.good) return false;
    }
    const bool is_named = row < mesh.table.material.size();
    unnamed = unnamed || !is_named;
    mesh.material_row[row] = static_cast<uint32_t>(materials.size());
    materials.name.push_back(is_named ? mesh.table.material[row] : std::string{});
    materials.reflectance.push_back(reflectance_of(mesh, row, names));
    materials.emission.emplace_back(0);
    materials.by_power.push_back(0);
    materials.is_heat.push_back(0);
    materials.node.push_back(node);
    materials.used.push_back(1);
  }
  warn_of(context.messages, mesh, unnamed, names);
  return true;
}

}  // namespace patchlight
