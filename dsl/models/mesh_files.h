// The mesh files of a scene: each is read and checked once, however often it is used.
#pragma once

#include "dsl/language/context.h"
#include "dsl/models/mesh_formats.h"

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
  const MeshFormat* format = nullptr;
  MeshTable table;
  // A row for each material of `table`, and a last one for faces that name none:
  std::vector<uint32_t> face_count;  // faces of it that have an area
  std::vector<uint32_t>
      material_row;  // of MaterialTable, made from what defines it; kNone: not asked for yet
  bool materials_read = false;
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
// file-too-large or those of the format's reader.
MeshFile* find_mesh(const Context& context, uint32_t node, MeshFiles& meshes);

}  // namespace patchlight
