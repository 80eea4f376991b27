// The list `objects` to polygons.
#pragma once

#include "materials.h"
#include "outlines.h"

namespace patchlight {

// Reads all objects into polygons, in the order of the file. Errors: empty-scene, missing-key,
// ambiguous-shape, unknown-material, bad-id, duplicate-id and those of the shapes.
void read_objects(const Context& context, uint32_t list, MaterialTable& materials, ObjectTable& objects,
                  OutlineTable& outlines);

// Reports polygons that share an id (duplicate-id).
void check_ids(const Context& context, const ObjectTable& objects, const OutlineTable& outlines);

}  // namespace patchlight
