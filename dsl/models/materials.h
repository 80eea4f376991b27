// The materials of a scene by name.
#pragma once

#include "dsl/language/number.h"
#include "engine/base/vector.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace patchlight {

struct MaterialTable {
  std::vector<std::string> name;  // with the prefix of its include
  std::vector<DRgb> reflectance;  // 0..1
  std::vector<DRgb> emission;     // W/m2
  std::vector<uint8_t> by_power;  // emission is in W, of all faces that an object has of it
  std::vector<uint8_t> is_heat;   // given by its emissivity
  std::vector<uint32_t> node;     // of its name
  std::vector<uint8_t> used;
  std::unordered_map<std::string, uint32_t> row_of;
  size_t named_count = 0;  // rows that the scene gave; those of meshes follow
  size_t size() const { return name.size(); }
};

// Reads the map `materials`. Errors: bad-name and those of read_map; warning reflectance-one.
void read_materials(const Context& context, uint32_t node, MaterialTable& materials);

// The row of the material that a scalar names, in its own file's names first, marked as used; kNone after
// unknown-material (with the nearest name).
uint32_t find_material(const Context& context, uint32_t node, MaterialTable& materials);

}  // namespace patchlight
