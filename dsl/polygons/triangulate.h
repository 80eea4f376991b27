// Flat polygons with holes to triangles, and triangles to better ones.
#pragma once

#include "dsl/polygons/flat_polygon.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

// Corners of a face as indices into points; a triangle repeats its third. Counter-clockwise.
using FaceCorners = std::array<uint32_t, 4>;
inline bool is_triangle(const FaceCorners& face) { return face[2] == face[3]; }

// Cuts a polygon that has passed check_rings into triangles of its own corners, by ear clipping with bridges
// to the holes (Eberly: Triangulation by Ear Clipping, 2002). The triangles cover the polygon and share whole
// edges. False when rounding leaves no way to cover it: the polygon is degenerate.
bool triangulate(const FlatPolygon& polygon, std::vector<FaceCorners>& triangles);

// Swaps diagonals until the triangles are the constrained Delaunay triangulation (Lawson 1977): no thin ones
// that the corners do not force. Outer edges stay.
void flip_to_delaunay(std::span<const DVec2> points, std::vector<FaceCorners>& triangles);

// Joins pairs of triangles into well-shaped convex quads, best pairs first: angles within 45..135 degrees,
// Jacobian ratio at most kJacobianRatioMax.
void merge_to_quads(std::span<const DVec2> points, std::vector<FaceCorners>& faces);

constexpr double kJacobianRatioMax = 2.5;  // of a quad: largest to smallest of the four corner triangles

// Largest to smallest corner triangle of a quad; above 1e30 when it is not convex.
double jacobian_ratio(const std::array<DVec2, 4>& quad);

}  // namespace patchlight
