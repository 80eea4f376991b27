// Moving, turning and stretching of polygons.
#pragma once

#include "dsl/language/values.h"
#include "dsl/polygons/outlines.h"

namespace patchlight {

// p goes to x * p.x + y * p.y + z * p.z + shift.
struct Transform {
  DVec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, shift{0};
};

// First `first`, then `second`.
Transform combine(const Transform& first, const Transform& second);

// Reads a list of steps (`transform`). False after unknown-key, missing-key, singular-transform, zero-axis
// ...
bool read_transform(const Context& context, uint32_t list, Transform& transform);

// Reads an object's transform: its list, or its short keys as scale, then rotate, then translate. `found`
// tells whether there is any. False after an error.
bool read_object_transform(const Context& context, const MapValues& object, Transform& transform,
                           bool& found);

// Applies a transform to all polygons from `first_polygon` on; a mirroring one turns their corners round, so
// that the lit side stays the lit side. `node` stands for the place of turned rings in messages.
void apply_transform(const Transform& transform, uint32_t node, size_t first_polygon, OutlineTable& outlines);

}  // namespace patchlight
