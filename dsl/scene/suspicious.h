// What is legal and probably not meant: walls whose corners run the wrong way, and polygons in one plane.
#pragma once

#include "dsl/models/materials.h"
#include "dsl/polygons/outlines.h"
#include "dsl/report/messages.h"
#include "dsl/scene/scene.h"
#include "dsl/yaml/tree.h"

namespace patchlight {

// Scenes with more polygons than this are made by programs: the searches below leave them out, as they do
// meshes.
constexpr size_t kPolygonsSearched = 20'000;

// Warns (flipped) of polygons whose corners run the other way round than those of their neighbours: two that
// share an edge should run along it in opposite directions. Neighbours share both corners of an edge, to the
// bit. Holes count as edges, two-sided polygons do not. Then warns of lamps that stand among the backs of
// polygons that do agree: a room turned inside out.
void warn_of_flipped(Messages& messages, const Tree& tree, const MaterialTable& materials,
                     const ObjectTable& objects, const OutlineTable& outlines);

// Warns (coincident) of polygons in one plane, up to a ray's offset, that overlap and face the same way: a
// lamp in the plane of its ceiling. The faces are those of `scene`, engine lengths; outlines and
// scene.polygons follow each other. Polygons with the very same corners are left to warn_of_coincident
// (faces.h).
void warn_of_overlaps(Messages& messages, const Tree& tree, const ObjectTable& objects,
                      const OutlineTable& outlines, const Scene& scene);

}  // namespace patchlight
