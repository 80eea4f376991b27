// The list `objects` to polygons.
#pragma once

#include "dsl/shapes/scene_objects.h"

#include <string>

namespace patchlight {

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
