// What MTL files say of an OBJ file's materials, to rows of the scene's materials.
#include "limits.h"
#include "mesh.h"
#include "scene_path.h"
#include "statements.h"

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

// The files that a mtllib names: one, whose name may have blanks, or several.
std::vector<FoundFile> find_libraries(const Messages& messages, std::string library,
                                      const std::string& folder) {
  std::replace(library.begin(), library.end(), '\\', '/');  // paths from Windows
  std::vector<FoundFile> found = {locate_scene_file(messages, library, folder, "include-not-found")};
  if (!found[0].path.empty() || library.find_first_of(" \t") == std::string::npos) return found;
  found.clear();
  for (size_t first = 0; first < library.size();) {
    const size_t end = std::min(library.find_first_of(" \t", first), library.size());
    if (end > first)
      found.push_back(
          locate_scene_file(messages, library.substr(first, end - first), folder, "include-not-found"));
    first = end + 1;
  }
  return found;
}

// Reads all MTL files of a mesh. A file that is not there, or not to be read, is a warning.
bool read_libraries(Messages& messages, MeshFile& mesh) {
  const std::string folder = messages.files[mesh.file].folder;
  bool good = true;
  for (size_t k = 0; k < mesh.obj.library.size(); ++k) {
    const Place place{mesh.file, mesh.obj.library_line[k], 1};
    for (const FoundFile& found : find_libraries(messages, mesh.obj.library[k], folder)) {
      if (found.path.empty()) {
        mesh.mtl_missing = true;
        add_warning(
            messages, place, found.slug,
            fmt::format("{}: its materials get a reflectance of {}", found.message, kDefaultReflectance));
        continue;
      }
      const uint32_t file =
          add_scene_file(messages, place, found.path, &Limits::mesh_bytes, messages.mesh_bytes);
      good = file != kNone && read_mtl(messages, file, mesh.mtl) && good;
    }
  }
  return good;
}

struct Names {
  std::vector<std::string> unknown, limited, all_light, textured, transparent, emitting;
};

// The reflectance of material `row` of the OBJ file; what is to be said of it goes to `names`.
DRgb reflectance_of(const MeshFile& mesh, size_t row, Names& names) {
  const DRgb fallback(kDefaultReflectance);
  if (row == mesh.obj.material.size()) return fallback;
  const std::string& name = mesh.obj.material[row];
  const auto found = mesh.mtl.row_of.find(name);
  if (found == mesh.mtl.row_of.end()) {
    names.unknown.push_back(name);
    return fallback;
  }
  const uint32_t m = found->second;
  if (mesh.mtl.textured[m]) names.textured.push_back(name);
  if (mesh.mtl.transparent[m]) names.transparent.push_back(name);
  if (mesh.mtl.emits[m]) names.emitting.push_back(name);
  if (!mesh.mtl.has_kd[m]) return fallback;
  const DRgb kd = mesh.mtl.reflectance[m], limited = glm::clamp(kd, DRgb(0), DRgb(1));
  if (kd != limited)
    names.limited.push_back(name);
  else if (std::max({kd.r, kd.g, kd.b}) == 1)
    names.all_light.push_back(name);
  return limited;
}

void warn_of(Messages& messages, const MeshFile& mesh, bool unnamed, const Names& names) {
  const auto place_in_obj = [&](const std::string& name) {
    return Place{mesh.file, mesh.obj.material_line[mesh.obj.material_row.at(name)], 1};
  };
  const auto place_in_mtl = [&](const std::string& name) { return mesh.mtl.place[mesh.mtl.row_of.at(name)]; };
  if (unnamed)
    add_warning(messages, {mesh.file, 1, 1}, "unknown-material",
                fmt::format("faces without a material get a reflectance of {}; give the mesh a `material`",
                            kDefaultReflectance));
  if (!names.unknown.empty() && !mesh.mtl_missing)
    add_warning(
        messages, place_in_obj(names.unknown[0]), "unknown-material",
        fmt::format("no MTL file defines {}: reflectance {}; `materials` or `material` of the mesh can "
                    "say better",
                    list_names(names.unknown), kDefaultReflectance));
  if (!names.limited.empty())
    add_warning(messages, place_in_mtl(names.limited[0]), "reflectance-range",
                fmt::format("Kd is beyond 0..1 in {}: limited", list_names(names.limited)));
  if (!names.all_light.empty())
    add_warning(messages, place_in_mtl(names.all_light[0]), "reflectance-one",
                fmt::format("Kd is 1 in {}: it keeps all light; in a closed room the passes never converge",
                            list_names(names.all_light)));
  std::string left_out;
  const std::string* first = nullptr;
  const auto add = [&](std::string_view what, const std::vector<std::string>& of) {
    if (of.empty()) return;
    left_out += fmt::format("{}{} of {}", left_out.empty() ? "" : ", ", what, list_names(of));
    if (!first) first = &of[0];
  };
  add("textures", names.textured);
  add("transparency", names.transparent);
  add("light (Ke)", names.emitting);
  if (first)
    add_warning(messages, place_in_mtl(*first), "mesh-simplified",
                fmt::format("only Kd is used; left out: {}", left_out));
}

}  // namespace

bool make_mtl_materials(const Context& context, uint32_t node, const std::vector<uint8_t>& wanted,
                        MeshFile& mesh, MaterialTable& materials) {
  Names names;
  bool unnamed = false;
  for (size_t row = 0; row < wanted.size(); ++row) {
    if (!wanted[row] || mesh.material_row[row] != kNone) continue;
    if (!mesh.mtl_read) {
      mesh.mtl_read = true;
      mesh.good = read_libraries(context.messages, mesh);
      if (!mesh.good) return false;
    }
    const bool is_named = row < mesh.obj.material.size();
    unnamed = unnamed || !is_named;
    mesh.material_row[row] = static_cast<uint32_t>(materials.size());
    materials.name.push_back(is_named ? mesh.obj.material[row] : std::string{});
    materials.reflectance.push_back(reflectance_of(mesh, row, names));
    materials.emission.emplace_back(0);
    materials.is_heat.push_back(0);
    materials.node.push_back(node);
    materials.used.push_back(1);
  }
  warn_of(context.messages, mesh, unnamed, names);
  return true;
}

}  // namespace patchlight
