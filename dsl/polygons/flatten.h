// Outlines checked and laid flat.
#pragma once

#include "dsl/polygons/flat_polygon.h"
#include "dsl/polygons/outlines.h"
#include "dsl/report/messages.h"
#include "dsl/yaml/tree.h"

#include <span>

namespace patchlight {

// Lays polygon `p` flat and checks it. False after an error: too-few-vertices, zero-area, non-planar,
// coordinate-too-large, self-intersecting, hole-outside, hole-touches, holes-overlap. Warnings:
// repeated-vertex, closed-ring, non-planar. `polygon` is written; its memory is reused from call to call.
bool flatten_polygon(Messages& messages, const Tree& tree, const OutlineTable& outlines, uint32_t p,
                     FlatPolygon& polygon);

// The same without a word, for an outline that has passed it before.
bool flatten_again(const OutlineTable& outlines, uint32_t p, FlatPolygon& polygon);

enum class MeshFace : uint8_t { kSound, kNoArea, kCrossing };

// The same for a face of a mesh, without a word: corners that repeat are left out, and corners may lie off
// one plane by any distance. An outline that touches itself may be a hole that a seam joins to it, which can
// be cut, or cross itself: only cutting it tells.
MeshFace flatten_mesh_face(std::span<const DVec3> corners, FlatPolygon& polygon);

}  // namespace patchlight
