// Wavefront OBJ: text to tables, strictly. Faces keep their corners: nothing is cut here.
#pragma once

#include "engine/base/vector.h"
#include "messages.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace patchlight {

// The polygons of one OBJ file.
struct ObjMesh {
  std::vector<DVec3> position;          // as in the file
  std::vector<uint32_t> corner;         // of all faces: rows of `position`
  std::vector<uint32_t> face_first{0};  // faces + 1; a face that was dropped has no corners
  std::vector<uint32_t> face_line;      // 1-based
  std::vector<uint32_t> face_material;  // row of `material`, or kNone
  std::vector<std::string> material;    // names behind usemtl that faces have, each once
  std::vector<uint32_t> material_line;  // 1-based, of the usemtl before the first such face
  std::unordered_map<std::string, uint32_t> material_row;  // of a name; kNone: no face has it
  std::vector<std::string> library;                        // what stands behind each mtllib
  std::vector<uint32_t> library_line;
  size_t face_count() const { return face_line.size(); }
};

// Reads v, f, usemtl and mtllib of messages.files[file] into an empty mesh. Indices are checked; texture
// coordinates, normals, groups, smoothing, lines and points are passed over. False after errors:
// mesh-invalid, non-finite, number-out-of-range, coordinate-too-large, too-many-polygons.
bool read_obj(Messages& messages, uint32_t file, ObjMesh& mesh);

}  // namespace patchlight
