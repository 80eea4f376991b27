// Wavefront MTL: the diffuse reflectances of an OBJ file's materials.
#include "dsl/models/mesh_formats.h"
#include "dsl/models/scene_path.h"
#include "dsl/models/statements.h"
#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

// One number for all channels, or three. False after an error.
bool read_colour(Messages& messages, StatementReader& reader, DRgb& colour) {
  const std::string_view rest = rest_of(reader);
  if (rest.starts_with("spectral") || rest.starts_with("xyz")) {
    add_error(messages, place_of(reader, rest), "mesh-invalid",
              "colours are read as r g b, not as 'spectral' or 'xyz'");
    return false;
  }
  if (!next_number(messages, reader, colour.r)) return false;
  colour.g = colour.b = colour.r;
  if (const std::string_view more = rest_of(reader); more.empty() || more[0] == '#') return true;
  return next_number(messages, reader, colour.g) && next_number(messages, reader, colour.b);
}

// Appends the materials of messages.files[file]. Only Kd, Ke, map_Kd, d and Tr are read. False after errors:
// mesh-invalid, non-finite, number-out-of-range.
bool read_mtl(Messages& messages, uint32_t file, MeshMaterials& table) {
  StatementReader reader = read_statements(messages, file);
  const size_t errors_before = messages.error_count, first = table.size();
  std::string_view keyword;
  bool has_d = false;  // of this material: d says more than Tr, which some programs write the wrong way round
  while (messages.error_count - errors_before < kErrorsShown && next_statement(reader, keyword)) {
    if (keyword == "newmtl") {
      table.name.emplace_back(rest_of(reader));
      table.place.push_back(place_of(reader, keyword));
      table.reflectance.emplace_back(0);
      table.has_reflectance.push_back(0);
      table.emits.push_back(0);
      table.textured.push_back(0);
      table.transparent.push_back(0);
      table.row_of.emplace(table.name.back(), static_cast<uint32_t>(table.size() - 1));
      has_d = false;
      continue;
    }
    if (table.size() == first) continue;  // belongs to no material
    DRgb colour(0);
    if (keyword == "Kd" && read_colour(messages, reader, colour)) {
      table.reflectance.back() = colour;
      table.has_reflectance.back() = 1;
    } else if (keyword == "Ke" && read_colour(messages, reader, colour)) {
      table.emits.back() = std::max({colour.r, colour.g, colour.b}) > 0;
    } else if (keyword == "map_Kd") {
      table.textured.back() = 1;
    } else if (keyword == "d" || keyword == "Tr") {
      if (rest_of(reader).starts_with("-halo")) next_word(reader);
      double value = 0;
      if (!next_number(messages, reader, value)) continue;
      if (keyword == "Tr" && has_d) continue;
      has_d = keyword == "d";
      table.transparent.back() = has_d ? value < 1 : value > 0;
    }
  }
  return messages.error_count == errors_before;
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

}  // namespace

// Reads all files that mtllib names. One that is not there, or not to be read, is a warning.
bool read_mtl_files(Messages& messages, uint32_t file, MeshTable& mesh) {
  const std::string folder = messages.files[file].folder;
  bool good = true;
  for (size_t k = 0; k < mesh.library.size(); ++k) {
    const Place place{file, mesh.library_line[k], 1};
    for (const FoundFile& found : find_libraries(messages, mesh.library[k], folder)) {
      if (found.path.empty()) {
        mesh.library_missing = true;
        add_warning(
            messages, place, found.slug,
            fmt::format("{}: its materials get a reflectance of {}", found.message, kDefaultReflectance));
        continue;
      }
      const uint32_t row =
          add_scene_file(messages, place, found.path, &Limits::mesh_bytes, messages.mesh_bytes);
      good = row != kNone && read_mtl(messages, row, mesh.defined) && good;
    }
  }
  return good;
}

}  // namespace patchlight
