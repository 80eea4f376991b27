// The OBJ files of a scene: each is read and checked once, however often it is used.
#pragma once

#include "materials.h"
#include "mtl.h"
#include "obj.h"

#include <deque>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace patchlight {

struct MeshFile {
  uint32_t file = kNone;  // row of Messages::files
  bool good = false;      // false: what is wrong with it was told
  ObjMesh obj;
  // A row for each material of `obj`, and a last one for faces that name none:
  std::vector<uint32_t> face_count;    // faces of it that have an area
  std::vector<uint32_t> material_row;  // of MaterialTable, made from the MTL's Kd; kNone: not asked for yet
  bool mtl_read = false;
  bool mtl_missing = false;  // some mtllib was not found
  MtlTable mtl;
};

struct MeshFiles {
  std::deque<MeshFile> files;
  std::unordered_map<std::string, uint32_t> by_path;  // canonical
  std::unordered_map<uint32_t, uint32_t> by_node;     // of the path in the scene's tree: for copies
  // Rows of MaterialTable for the materials of a mesh, by the node of its path and the object's material: for
  // copies.
  std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> material_rows;
};

// The file that a scalar names, relative to the file that it stands in. Faces without area are emptied, with
// one warning (zero-area); others tell of faces that are far from flat (non-planar) or cross themselves
// (self-intersecting). nullptr after an error: include-outside-root, cannot-open, not-a-regular-file,
// file-too-large or those of read_obj.
MeshFile* find_mesh(const Context& context, uint32_t node, MeshFiles& meshes);

// Sets material_row where `wanted` is set, from the MTL files, which are read when this is first needed. What
// is missing there gets kDefaultReflectance. `node` stands for the mesh in the scene. One warning each tells
// what was not found (include-not-found, unknown-material), what lies beyond 0..1 (reflectance-range), and
// what is left out (mesh-simplified). False after errors: those of read_mtl.
bool make_mtl_materials(const Context& context, uint32_t node, const std::vector<uint8_t>& wanted,
                        MeshFile& mesh, MaterialTable& materials);
constexpr double kDefaultReflectance = 0.8;

}  // namespace patchlight
