// What is legal and probably not meant: walls whose corners run the wrong way.
#pragma once

#include "dsl/models/materials.h"
#include "dsl/polygons/outlines.h"
#include "dsl/report/messages.h"
#include "dsl/scene/scene.h"
#include "dsl/yaml/tree.h"

#include <span>

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

// Warns (inside-out) of meshes that are closed and whose faces all look inward, though neither a lamp nor a
// camera is in them. Eyes of cameras are in file units.
void warn_of_inside_out_meshes(Messages& messages, const Tree& tree, const MaterialTable& materials,
                               const ObjectTable& objects, const OutlineTable& outlines,
                               std::span<const Camera> cameras);

}  // namespace patchlight
