// The mesh files of a scene, and which of their faces are of use.
#include "dsl/models/mesh_files.h"

#include "dsl/language/values.h"
#include "dsl/models/scene_path.h"
#include "dsl/polygons/cut.h"
#include "dsl/polygons/flatten.h"
#include "dsl/report/limits.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

// Faces of one kind: how many, and which came first.
struct Found {
  uint32_t count = 0, first_line = 0;
  void add(uint32_t line) {
    if (count++ == 0) first_line = line;
  }
  std::string text() const {
    return count == 1 ? "this face" : fmt::format("{} faces, this one first,", count);
  }
};

// Empties faces without area and counts the others by material. What is odd about faces is told in one
// warning a kind.
void check_faces(Messages& messages, MeshFile& mesh) {
  MeshTable& table = mesh.table;
  mesh.face_count.assign(table.material.size() + 1, 0);
  mesh.material_row.assign(table.material.size() + 1, kNone);
  Found thin, bent, crossing;
  std::vector<DVec3> corners;
  FlatPolygon flat;
  CutFaces cut;
  uint32_t first = 0, written = 0;
  for (size_t f = 0; f < table.face_count(); ++f) {
    const uint32_t last = table.face_first[f + 1];
    corners.clear();
    for (uint32_t k = first; k < last; ++k) corners.push_back(table.position[table.corner[k]]);
    const MeshFace kind = flatten_mesh_face(corners, flat);
    if (kind == MeshFace::kNoArea) {
      thin.add(table.face_line[f]);
    } else {
      for (uint32_t k = first; k < last; ++k) table.corner[written++] = table.corner[k];
      ++mesh.face_count[table.face_material[f] == kNone ? table.material.size() : table.face_material[f]];
      if (flat.off_plane > kNonPlanarMax) bent.add(table.face_line[f]);
      // A hole that a seam joins to the outline touches it, and is cut well.
      if (kind == MeshFace::kCrossing && !cut_polygon(flat, false, cut)) crossing.add(table.face_line[f]);
    }
    first = last;
    table.face_first[f + 1] = written;
  }
  const auto warn = [&](const Found& found, std::string_view slug, std::string_view what) {
    if (found.count > 0)
      add_warning(messages, {mesh.file, found.first_line, 1}, slug, fmt::format("{} {}", found.text(), what));
  };
  warn(thin, "zero-area", "without area: left out");
  warn(bent, "non-planar", "with corners off one plane by more than 2 % of their size: cut into triangles");
  warn(crossing, "self-intersecting", "with an outline that crosses itself: cut as well as it can be");
  if (thin.count == table.face_count())
    add_error(messages, {mesh.file, thin.first_line, 1}, "mesh-invalid", "no face of this file has an area");
}

uint32_t load_mesh(const Context& context, uint32_t node, MeshFiles& meshes) {
  Messages& messages = context.messages;
  const Place place = place_of(context.tree, node);
  std::string name;
  if (!read_text(context, node, name)) return kNone;
  const auto path = find_scene_file(messages, place, name, folder_of(messages, place), "cannot-open");
  if (path.empty()) return kNone;
  const auto [row, is_new] =
      meshes.by_path.emplace(path.string(), static_cast<uint32_t>(meshes.files.size()));
  if (!is_new) return row->second;
  MeshFile& mesh = meshes.files.emplace_back();
  mesh.file = add_scene_file(messages, place, path, &Limits::mesh_bytes, messages.mesh_bytes);
  mesh.format = &format_of_mesh(name);
  if (mesh.file == kNone || !mesh.format->read(messages, mesh.file, mesh.table)) return row->second;
  const size_t errors_before = messages.error_count;
  check_faces(messages, mesh);
  mesh.good = messages.error_count == errors_before;
  return row->second;
}

}  // namespace

MeshFile* find_mesh(const Context& context, uint32_t node, MeshFiles& meshes) {
  auto known = meshes.by_node.find(node);
  if (known == meshes.by_node.end())
    known = meshes.by_node.emplace(node, load_mesh(context, node, meshes)).first;
  if (known->second == kNone) return nullptr;
  MeshFile& mesh = meshes.files[known->second];
  return mesh.good ? &mesh : nullptr;
}

}  // namespace patchlight
