// Cells of a quadtree on a face, and points of a face.
//
// A quad's point is the bilinear p(u, v) of its corners (0,0) (1,0) (1,1) (0,1); a triangle's is the linear
// one of (0,0) (1,0) (0,1). A cell halves both parameters; a triangle's four children are its corners 0, 1, 2
// and, turned by half a turn, its middle:
//
//      2 --- 3       v      quads:      2 | 3     triangles:     2
//      |     |       ^                  --+--                   /3\    .
//      0 --- 1       +-> u              0 | 1                  0---1
//
// The path from the root is kept as two bits a level, left-aligned in 32 bits, so that the cells of a face
// sort by place and a cell owns the codes [cell, cell + cell_span(level)).
#pragma once

#include "engine/tables.h"

#include <algorithm>
#include <bit>

namespace patchlight {

constexpr uint32_t kLevelMax = 16;

// 2^-level: the size of a cell in the parameters of its face.
inline float cell_size(uint32_t level) { return std::bit_cast<float>((127 - level) << 23); }

// Codes of level kLevelMax below a cell of this level; the root has 2^32 of them.
inline uint64_t cell_span(uint32_t level) { return uint64_t{1} << (32 - 2 * level); }
// The cell of a lower level that holds this one.
inline uint32_t cell_ancestor(uint32_t cell, uint32_t level) {
  return level == 0 ? 0 : cell & ~static_cast<uint32_t>(cell_span(level) - 1);
}
// Which child of its parent a cell of this level (>= 1) is.
inline uint32_t cell_child(uint32_t cell, uint32_t level) { return cell >> (32 - 2 * level) & 3; }

// A cell by its name.
struct CellName {
  uint32_t face = 0, cell = 0, level = 0;
};
inline CellName name_cell(const PatchTable& leaves, size_t row) {
  return {leaves.face[row], leaves.cell[row], leaves.level[row]};
}

// A cell's place in the parameters of its face: its own parameters (s, t) are at origin + size * (s, t). size
// is negative for a triangle's turned cells.
struct CellFrame {
  Vec2 origin;
  float size;
};
CellFrame make_triangle_cell_frame(uint32_t cell, uint32_t level);
inline CellFrame make_cell_frame(bool triangle, uint32_t cell, uint32_t level) {
  if (triangle) return make_triangle_cell_frame(cell, level);
  // Even bits to the low half, odd bits to the high half, both at once.
  uint64_t x = (cell | uint64_t{cell} << 31) & 0x5555555555555555ull;
  x = (x | x >> 1) & 0x3333333333333333ull;
  x = (x | x >> 2) & 0x0f0f0f0f0f0f0f0full;
  x = (x | x >> 4) & 0x00ff00ff00ff00ffull;
  x |= x >> 8;
  return {{static_cast<float>(x & 0xffff) * 0x1p-16f, static_cast<float>(x >> 32 & 0xffff) * 0x1p-16f},
          cell_size(level)};
}

// The cell of level kLevelMax at (u, v); parameters outside the face are clamped to it.
uint32_t find_triangle_cell(Vec2 uv);
inline uint32_t find_cell(bool triangle, Vec2 uv) {
  if (triangle) return find_triangle_cell(uv);
  const auto steps = [](float x) {
    return static_cast<uint64_t>(static_cast<int32_t>(std::clamp(x * 65536.0f, 0.0f, 65535.0f)));
  };
  uint64_t x = steps(uv.x) | steps(uv.y) << 32;
  x = (x | x << 8) & 0x00ff00ff00ff00ffull;
  x = (x | x << 4) & 0x0f0f0f0f0f0f0f0full;
  x = (x | x << 2) & 0x3333333333333333ull;
  x = (x | x << 1) & 0x5555555555555555ull;
  return static_cast<uint32_t>(x | x >> 31);
}

// Frames for all faces.
FaceFrameTable make_face_frames(const FaceTable& faces);

inline Vec3 face_point(const FaceFrameTable& frames, uint32_t face, Vec2 uv) {
  return frames.origin[face] + uv.x * frames.edge_u[face] + uv.y * frames.edge_v[face] +
         uv.x * uv.y * frames.twist[face];
}
// Parameters of a point in the plane of the face; outside it they leave 0..1.
Vec2 undo_twist(const FaceFrameTable& frames, uint32_t face, Vec2 target);
inline Vec2 find_face_parameters(const FaceFrameTable& frames, uint32_t face, Vec3 point) {
  const Vec3 p = point - frames.origin[face];
  const Vec2 target(dot(p, frames.dual_u[face]), dot(p, frames.dual_v[face]));
  return frames.affine[face] ? target : undo_twist(frames, face, target);
}

// The corners of a cell, counter-clockwise from the lit side; a triangle repeats its third.
std::array<Vec2, 4> cell_corner_parameters(bool triangle, uint32_t cell, uint32_t level);
std::array<Vec3, 4> cell_corners(const FaceFrameTable& frames, uint32_t face, uint32_t cell, uint32_t level);
float cell_area(const FaceFrameTable& frames, uint32_t face, uint32_t cell, uint32_t level);
// The square root of the area of all faces that are no mere lamps (of all, if all are).
float find_scene_scale(const FaceTable& faces, const FaceFrameTable& frames);
float longest_edge(const std::array<Vec3, 4>& corners);
Vec3 cell_centre(const FaceFrameTable& frames, uint32_t face, uint32_t cell, uint32_t level);

// A point of the unit square to parameters of a cell, uniform in them.
inline Vec2 cell_sample(bool triangle, const CellFrame& cell, Vec2 p) {
  if (triangle) {
    // Heitz: A Low-Distortion Map Between Triangle and Square, 2019.
    if (p.y > p.x) {
      p.x *= 0.5f, p.y -= p.x;
    } else {
      p.y *= 0.5f, p.x -= p.y;
    }
  }
  return cell.origin + cell.size * p;
}

}  // namespace patchlight
