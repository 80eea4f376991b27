// From one value a leaf to a surface of values without cracks: values at shared corners, bilinear between
// them.
#pragma once

#include "engine/mesh/quadtree.h"

namespace patchlight {

VertexTable make_vertices(const PatchTable& leaves, const FaceFrameTable& frames, const FaceLinkTable& links);

struct ReconstructSettings {
  // Steps that bring the mean of the surface over each leaf back to the leaf's value: 0 is the plain mean of
  // the leaves around a corner, which blurs; more follow edges more closely and keep more noise.
  uint32_t sharpen_steps = 0;
  // The same for corners on the border of a polygon, where plain means would flatten the slope.
  uint32_t border_steps = 2;
};

// Leaves with their corners.
struct LeafSurface {
  const VertexTable& vertices;
  const PatchTable& leaves;
  const FaceFrameTable& frames;
};

// Values at vertices from values of leaves, both W/m2. Leaves count by the square of their exposed share.
// Values stay within the range of the leaves around an inner vertex, and >= 0 everywhere.
std::vector<Rgb> reconstruct(const LeafSurface& surface, std::span<const Rgb> leaf_values,
                             const ReconstructSettings& settings);

// The mean of the surface over a leaf: of its corners.
inline Rgb leaf_mean(const LeafSurface& surface, std::span<const Rgb> vertex_values, size_t row) {
  const auto& corner = surface.vertices.leaf_vertex[row];
  const Rgb three = vertex_values[corner[0]] + vertex_values[corner[1]] + vertex_values[corner[2]];
  return surface.frames.triangle[surface.leaves.face[row]] ? three / 3.0f
                                                           : (three + vertex_values[corner[3]]) * 0.25f;
}

// The surface's value at (u, v) of the face of leaf `row`, which must hold that point.
inline Rgb sample_surface(const LeafSurface& surface, std::span<const Rgb> vertex_values, uint32_t row,
                          Vec2 uv) {
  const auto& [vertices, leaves, frames] = surface;
  const bool triangle = frames.triangle[leaves.face[row]];
  const CellFrame cell = make_cell_frame(triangle, leaves.cell[row], leaves.level[row]);
  const Vec2 st = (uv - cell.origin) / cell.size;
  const auto& corner = vertices.leaf_vertex[row];
  if (triangle)
    return (1 - st.x - st.y) * vertex_values[corner[0]] + st.x * vertex_values[corner[1]] +
           st.y * vertex_values[corner[2]];
  return (1 - st.y) * ((1 - st.x) * vertex_values[corner[0]] + st.x * vertex_values[corner[1]]) +
         st.y * ((1 - st.x) * vertex_values[corner[3]] + st.x * vertex_values[corner[2]]);
}

}  // namespace patchlight
