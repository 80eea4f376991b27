// The polygons of a mesh and its materials, whatever the format of its file. Faces keep their corners:
// nothing is cut here.
#pragma once

#include "dsl/report/messages.h"
#include "engine/base/vector.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace patchlight {

constexpr double kDefaultReflectance = 0.8;  // of faces whose material says nothing

// Materials as the mesh's file, or a file beside it, defines them.
struct MeshMaterials {
  std::vector<std::string> name;
  std::vector<Place> place;       // of the definition
  std::vector<DRgb> reflectance;  // diffuse, as in the file
  std::vector<uint8_t> has_reflectance;
  std::vector<uint8_t> emits;                        // it gives off light
  std::vector<uint8_t> textured;                     // its reflectance has a picture
  std::vector<uint8_t> transparent;                  // it lets light through
  std::unordered_map<std::string, uint32_t> row_of;  // the first of each name
  size_t size() const { return name.size(); }
};

// The polygons of one file.
struct MeshTable {
  std::vector<DVec3> position;          // as in the file
  std::vector<uint32_t> corner;         // of all faces: rows of `position`
  std::vector<uint32_t> face_first{0};  // faces + 1; a face that was dropped has no corners
  std::vector<uint32_t> face_line;      // 1-based; 0: the file has no lines
  std::vector<uint32_t> face_material;  // row of `material`, or kNone
  std::vector<std::string> material;    // names that faces have, each once
  std::vector<uint32_t> material_line;  // 1-based, where the first such face gets it
  std::unordered_map<std::string, uint32_t> material_row;  // of a name; kNone: no face has it
  std::vector<std::string> library;                        // files that define the materials
  std::vector<uint32_t> library_line;
  bool library_missing = false;  // some of them are not there
  MeshMaterials defined;
  size_t face_count() const { return face_line.size(); }
};

}  // namespace patchlight
