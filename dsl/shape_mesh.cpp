// mesh: the faces of a Wavefront OBJ file, ID.0, ID.1 ... in the file's order.
#include "limits.h"
#include "mesh.h"
#include "shapes.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

// The map `materials`: names of the OBJ file to materials of the scene. `rows` gets the rows of
// MaterialTable. False after unknown-material.
bool read_mesh_materials(const ShapeInput& input, uint32_t node, const MeshFile& mesh,
                         std::vector<uint32_t>& rows) {
  const Tree& tree = input.context.tree;
  const ObjMesh& obj = mesh.obj;
  bool good = true;
  for (uint32_t key = tree.nodes[node].first; key != kNone;) {
    const uint32_t value = tree.nodes[key].next;
    const std::string name(text_of(tree, key));
    const auto found = obj.material_row.find(name);
    if (found == obj.material_row.end()) {
      const std::string near =
          wants_errors(input.context.messages) ? did_you_mean(name, obj.material) : std::string{};
      add_error(input.context.messages, place_of(tree, key), "unknown-material",
                fmt::format("the OBJ file has no material '{}'{}", escape_text(name),
                            obj.material.empty() ? ": its faces name none; give the mesh a `material`"
                            : near.empty() ? fmt::format("; its first is '{}'", escape_text(obj.material[0]))
                                           : fmt::format("; did you mean '{}'?", near)));
      good = false;
    }
    const uint32_t row = find_material(input.context, value, input.scene.materials);
    if (row == kNone)
      good = false;
    else if (found != obj.material_row.end() && found->second != kNone)
      rows[found->second] = row;
    key = tree.nodes[value].next;
  }
  return good;
}

// A row of MaterialTable for each material of the OBJ file and, last, for faces that name none: from
// `materials`, else `material`, else the MTL file. False after an error.
bool choose_materials(const ShapeInput& input, MeshFile& mesh, std::vector<uint32_t>& rows) {
  if (!rows.empty()) return true;  // by a copy of this object
  rows.assign(mesh.obj.material.size() + 1, kNone);
  const uint32_t map = value_of(input.object, "materials").node;
  if (map != kNone && !read_mesh_materials(input, map, mesh, rows)) return false;
  std::vector<uint8_t> wanted(rows.size(), 0);
  for (size_t k = 0; k < rows.size(); ++k) {
    if (rows[k] == kNone) rows[k] = input.own.material;
    wanted[k] = rows[k] == kNone && mesh.face_count[k] > 0;
  }
  if (!make_mtl_materials(input.context, input.node, wanted, mesh, input.scene.materials)) return false;
  for (size_t k = 0; k < rows.size(); ++k)
    if (wanted[k]) rows[k] = mesh.material_row[k];
  return true;
}

}  // namespace

void build_mesh(const ShapeInput& input) {
  MeshFile* mesh = find_mesh(input.context, input.node, input.scene.meshes);
  if (!mesh) return;
  const ObjMesh& obj = mesh->obj;
  const Limits& limits = input.context.messages.limits;
  uint64_t count = 0, corners_count = 0;
  if (__builtin_mul_overflow(obj.face_count(), input.context.copies, &count) || count > limits.polygons ||
      __builtin_mul_overflow(obj.corner.size(), input.context.copies, &corners_count) ||
      corners_count > kCornersPerPolygon * limits.polygons) {
    add_error(input.context.messages, place_of(input.context.tree, input.node), "too-many-polygons",
              fmt::format("{} faces of {} corners, {} times, take the scene above the limit of {}",
                          obj.face_count(), obj.corner.size(), input.context.copies,
                          limit_text(limits, &Limits::polygons)));
    return;
  }
  std::vector<uint32_t>& material = input.scene.meshes.material_rows[{input.node, input.own.material}];
  if (!choose_materials(input, *mesh, material)) return;
  std::vector<DVec3> corners;
  for (size_t f = 0; f < obj.face_count(); ++f) {
    corners.clear();
    for (uint32_t k = obj.face_first[f]; k < obj.face_first[f + 1]; ++k)
      corners.push_back(obj.position[obj.corner[k]]);
    if (corners.empty()) continue;
    const uint32_t of_file = obj.face_material[f];
    add_polygon(input.scene.outlines, input.object_row, fmt::format("{}.{}", input.id, f),
                material[of_file == kNone ? obj.material.size() : of_file], input.node, corners);
  }
}

}  // namespace patchlight
