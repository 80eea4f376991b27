// What the objects of a scene become, and what they hand on to those that stand in them.
#pragma once

#include "dsl/models/materials.h"
#include "dsl/models/mesh_files.h"
#include "dsl/polygons/outlines.h"

#include <string>
#include <unordered_map>

namespace patchlight {

// What an object takes from the group or repeat that it stands in, where it does not say otherwise.
struct Inherited {
  uint32_t top = 0;           // row of ObjectTable::top_ids
  uint32_t material = kNone;  // row of MaterialTable
  bool two_sided = false;
  double patch_size = 0, patch_size_min = 0;  // file units; 0: as the settings say
  uint32_t subdivide = 1;
  uint32_t subdivide_node = kNone;
};

// Ids that were given in one list of objects, or in the lists `objects` of all files of one prefix.
using IdTable = std::unordered_map<std::string, uint32_t>;  // to the node of the id

// All that the objects of a scene become.
struct SceneObjects {
  MaterialTable materials;
  MeshFiles meshes;
  ObjectTable objects;
  OutlineTable outlines;
  uint64_t reads = 0;    // values that repeats read, each time anew
  bool is_full = false;  // there are more than the limits allow: it was told, and no more are added
  IdTable ids;           // of the lists `objects`
};

}  // namespace patchlight
