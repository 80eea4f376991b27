// The list `objects` to polygons.
#pragma once

#include "materials.h"
#include "mesh.h"
#include "outlines.h"

#include <string>
#include <unordered_map>

namespace patchlight {

// What an object takes from the group or repeat that it stands in, where it does not say otherwise.
struct Inherited {
  uint32_t top = 0;           // row of ObjectTable::top_ids
  uint32_t material = kNone;  // row of MaterialTable
  bool two_sided = false;
  double patch_size = 0;  // file units; 0: as the settings say
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

// Reads all objects of a list, in the order of the file; ids get the context's prefix. Errors: missing-key,
// ambiguous-shape, unknown-material, bad-id, too-many-polygons and those of the shapes.
void read_objects(const Context& context, uint32_t list, SceneObjects& scene);

// What an object is called: `prefix` and its own id, or `unnamed` where it has none.
struct ObjectName {
  std::string prefix, unnamed;
};

// True where the object's own id is taken in its list already: duplicate-id is reported. Else notes it.
bool is_id_taken(const Context& context, uint32_t object, const std::string& prefix, IdTable& ids);

// Reads one object, with all that stands in it.
void read_object(const Context& context, uint32_t node, const ObjectName& name, const Inherited& inherited,
                 SceneObjects& scene);

// Reports polygons of different objects that share an id (duplicate-id): those of object b and an object
// b.floor.
void check_ids(const Context& context, const ObjectTable& objects, const OutlineTable& outlines);

}  // namespace patchlight
