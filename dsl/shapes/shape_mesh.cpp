// mesh: the faces of a mesh file, ID.0, ID.1 ... in the file's order.
#include "dsl/models/mesh_materials.h"
#include "dsl/report/limits.h"
#include "dsl/shapes/shape.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

constexpr KeyRow kBeside[] = {
    {"materials", ValueType::kMap, false, "", 0, 0, "", "*text",
     "Beside mesh: materials by the names that the OBJ file gives them."},
};

// The map `materials`: names of the mesh file to materials of the scene. `rows` gets the rows of
// MaterialTable. False after unknown-material.
bool read_mesh_materials(const ShapeInput& input, uint32_t node, const MeshFile& mesh,
                         std::vector<uint32_t>& rows) {
  const Tree& tree = input.context.tree;
  const MeshTable& table = mesh.table;
  bool good = true;
  for (uint32_t key = tree.nodes[node].first; key != kNone;) {
    const uint32_t value = tree.nodes[key].next;
    const std::string name(text_of(tree, key));
    const auto found = table.material_row.find(name);
    if (found == table.material_row.end()) {
      const std::string near =
          wants_errors(input.context.messages) ? did_you_mean(name, table.material) : std::string{};
      add_error(
          input.context.messages, place_of(tree, key), "unknown-material",
          fmt::format("the {} file has no material '{}'{}", mesh.format->words.file, escape_text(name),
                      table.material.empty() ? ": its faces name none; give the mesh a `material`"
                      : near.empty() ? fmt::format("; its first is '{}'", escape_text(table.material[0]))
                                     : fmt::format("; did you mean '{}'?", near)));
      good = false;
    }
    const uint32_t row = find_material(input.context, value, input.scene.materials);
    if (row == kNone)
      good = false;
    else if (found != table.material_row.end() && found->second != kNone)
      rows[found->second] = row;
    key = tree.nodes[value].next;
  }
  return good;
}

// A row of MaterialTable for each material of the mesh and, last, for faces that name none: from
// `materials`, else `material`, else what defines it. False after an error.
bool choose_materials(const ShapeInput& input, MeshFile& mesh, std::vector<uint32_t>& rows) {
  if (!rows.empty()) return true;  // by a copy of this object
  rows.assign(mesh.table.material.size() + 1, kNone);
  const uint32_t map = value_of(input.object, "materials").node;
  if (map != kNone && !read_mesh_materials(input, map, mesh, rows)) return false;
  std::vector<uint8_t> wanted(rows.size(), 0);
  for (size_t k = 0; k < rows.size(); ++k) {
    if (rows[k] == kNone) rows[k] = input.own.material;
    wanted[k] = rows[k] == kNone && mesh.face_count[k] > 0;
  }
  if (!make_mesh_materials(input.context, input.node, wanted, mesh, input.scene.materials)) return false;
  for (size_t k = 0; k < rows.size(); ++k)
    if (wanted[k]) rows[k] = mesh.material_row[k];
  return true;
}

void build(const ShapeInput& input) {
  input.scene.objects.is_mesh[input.object_row] = input.scene.objects.is_smooth[input.object_row] = 1;
  MeshFile* mesh = find_mesh(input.context, input.node, input.scene.meshes);
  if (!mesh) return;
  const MeshTable& table = mesh->table;
  const Limits& limits = input.context.messages.limits;
  uint64_t count = 0, corners_count = 0;
  if (__builtin_mul_overflow(table.face_count(), input.context.copies, &count) || count > limits.polygons ||
      __builtin_mul_overflow(table.corner.size(), input.context.copies, &corners_count) ||
      corners_count > kCornersPerPolygon * limits.polygons) {
    add_error(input.context.messages, place_of(input.context.tree, input.node), "too-many-polygons",
              fmt::format("{} faces of {} corners, {} times, take the scene above the limit of {}",
                          table.face_count(), table.corner.size(), input.context.copies,
                          limit_text(limits, &Limits::polygons)));
    return;
  }
  std::vector<uint32_t>& material = input.scene.meshes.material_rows[{input.node, input.own.material}];
  if (!choose_materials(input, *mesh, material)) return;
  std::vector<DVec3> corners;
  for (size_t f = 0; f < table.face_count(); ++f) {
    corners.clear();
    for (uint32_t k = table.face_first[f]; k < table.face_first[f + 1]; ++k)
      corners.push_back(table.position[table.corner[k]]);
    if (corners.empty()) continue;
    const uint32_t of_file = table.face_material[f];
    add_polygon(input.scene.outlines, input.object_row, fmt::format("{}.{}", input.id, f),
                material[of_file == kNone ? table.material.size() : of_file], input.node, corners);
  }
}

}  // namespace

extern const ShapeRow kMeshShape = {
    .name = "mesh",
    .type = ValueType::kText,
    .beside = kBeside,
    .build = build,
    .description = "Path of a Wavefront OBJ file: a polygon for each of its faces.",
};

}  // namespace patchlight
