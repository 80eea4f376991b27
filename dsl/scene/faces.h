// Checked and cut polygons to the engine's table of faces.
#pragma once

#include "dsl/models/materials.h"
#include "dsl/polygons/outlines.h"
#include "dsl/scene/scene.h"

namespace patchlight {

// Checks, cuts and converts all polygons: fills scene.faces, scene.polygons, scene.origin and
// scene.units_per_length. Errors: those of flatten_polygon, too-many-patches and coordinate-too-large;
// warnings: those of flatten_polygon, coincident, scale-ratio. Writes nothing useful when errors were
// reported. scene.fine_corners is filled, too, where `fine_corners` is set.
void make_faces(Messages& messages, const Tree& tree, const MaterialTable& materials,
                const ObjectTable& objects, const OutlineTable& outlines, uint64_t start_patches_max,
                Scene& scene, bool fine_corners = false);

}  // namespace patchlight
