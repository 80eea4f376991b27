// What mesh files say of their materials, to rows of the scene's materials.
#pragma once

#include "dsl/language/context.h"
#include "dsl/models/materials.h"
#include "dsl/models/mesh_files.h"

#include <vector>

namespace patchlight {

// Sets material_row where `wanted` is set, from what the mesh's file or the files beside it define; the
// latter are read when this is first needed. What is missing gets kDefaultReflectance. `node` stands for the
// mesh in the scene. One warning each tells what was not found (include-not-found, unknown-material), what
// lies beyond 0..1 (reflectance-range), and what is left out (mesh-simplified). False after errors: those of
// the format's reader of materials.
bool make_mesh_materials(const Context& context, uint32_t node, const std::vector<uint8_t>& wanted,
                         MeshFile& mesh, MaterialTable& materials);

}  // namespace patchlight
