// Flat polygons to faces: triangles and convex quads that the engine's quadtrees can split well.
#pragma once

#include "dsl/polygons/triangulate.h"

namespace patchlight {

// The faces of one polygon. Points are the polygon's own first, then those that the cutting added.
struct CutFaces {
  std::vector<DVec3> points;  // file units
  std::vector<FaceCorners> faces;
};

// Cuts a polygon into faces that share whole edges or nothing: a quad near a parallelogram stays or becomes a
// row of pieces, a rectilinear polygon becomes a grid, everything else triangles joined to quads where these
// are well shaped. `emits`: each face is a lamp of its own, so few faces are made; and
// few of a mesh, which has many as it is. False when the polygon is
// degenerate. `cut` is written; its memory is reused.
bool cut_polygon(const FlatPolygon& polygon, bool emits, CutFaces& cut);

// A polygon whose edges all follow two perpendicular directions, cut along the lines of all of them. False,
// with nothing written, when it is no such polygon or the grid would have more than kGridCellsMax cells.
bool cut_grid(const FlatPolygon& polygon, CutFaces& cut);
constexpr size_t kGridCellsMax = 4096;
// The same for polygons of one plane (one origin, axes and size), along the lines of them all: they meet in
// whole edges. A row a polygon.
bool cut_grids(std::span<const FlatPolygon> polygons, std::span<CutFaces> cuts);

// A convex, roundish polygon with many corners: rings of triangles inwards, each with half as many corners,
// so that none is a sliver. False when it is no such polygon. Flat coordinates of all points are left in
// `flat`.
bool cut_rings(const FlatPolygon& polygon, std::vector<DVec2>& flat, CutFaces& cut);

// The point of the plane at flat coordinates, in file units.
inline DVec3 point_at(const FlatPolygon& polygon, DVec2 flat) {
  return polygon.origin + (polygon.axis_u * flat.x + polygon.axis_v * flat.y) * polygon.size;
}

}  // namespace patchlight
