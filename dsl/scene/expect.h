// The list `expect`.
#pragma once

#include "dsl/language/number.h"
#include "dsl/scene/scene.h"

namespace patchlight {

// Reads what `verify` is to check into scene.expectations; scene.polygons is complete. Errors: those of
// read_map, bad-id for an object that the scene does not have, and snapshot-beyond-passes.
void read_expectations(const Context& context, uint32_t list, Scene& scene);

}  // namespace patchlight
