// Wavefront MTL: the diffuse reflectances of an OBJ file's materials.
#pragma once

#include "engine/base/vector.h"
#include "messages.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace patchlight {

struct MtlTable {
  std::vector<std::string> name;
  std::vector<Place> place;       // of newmtl
  std::vector<DRgb> reflectance;  // Kd, as in the file
  std::vector<uint8_t> has_kd;
  std::vector<uint8_t> emits;                        // Ke is above 0
  std::vector<uint8_t> textured;                     // its Kd has a picture
  std::vector<uint8_t> transparent;                  // it lets light through
  std::unordered_map<std::string, uint32_t> row_of;  // the first of each name
  size_t size() const { return name.size(); }
};

// Appends the materials of messages.files[file]. Only Kd, Ke, map_Kd, d and Tr are read. False after errors:
// mesh-invalid, non-finite, number-out-of-range.
bool read_mtl(Messages& messages, uint32_t file, MtlTable& table);

}  // namespace patchlight
