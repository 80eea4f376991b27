// Lamps by their power: what an object gives off in all, to what each of its faces does.
#pragma once

#include "dsl/models/materials.h"
#include "dsl/polygons/outlines.h"
#include "dsl/report/messages.h"
#include "dsl/scene/scene.h"
#include "dsl/yaml/tree.h"

namespace patchlight {

// Spreads the power of materials that have one evenly over the faces of each object that is made of them,
// both sides of two-sided ones counted: sets scene.faces.emission. Outlines and scene.polygons follow each
// other. Error: emission-range, where that is more than an emission may be.
void share_power(Messages& messages, const Tree& tree, const MaterialTable& materials,
                 const ObjectTable& objects, const OutlineTable& outlines, Scene& scene);

}  // namespace patchlight
