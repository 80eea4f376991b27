// Quadtree cells to parameters, points and areas, and back.
#include "engine/mesh/cell.h"

namespace patchlight {
uint32_t find_triangle_cell(Vec2 uv) {
  // Into the triangle first: rounding puts hits a hair outside of it.
  uv = {std::clamp(uv.x, 0.0f, 1.0f), std::clamp(uv.y, 0.0f, 1.0f)};
  if (const float sum = uv.x + uv.y; sum > 1) uv /= sum;
  uint32_t cell = 0;
  for (uint32_t level = 0; level < kLevelMax; ++level) {
    uint32_t child = 0;
    if (uv.x >= 0.5f) {
      child = 1, uv = {2 * uv.x - 1, 2 * uv.y};
    } else if (uv.y >= 0.5f) {
      child = 2, uv = {2 * uv.x, 2 * uv.y - 1};
    } else if (uv.x + uv.y <= 0.5f) {
      uv *= 2.0f;
    } else {
      child = 3, uv = {1 - 2 * uv.x, 1 - 2 * uv.y};
    }
    cell = cell << 2 | child;
  }
  return cell;
}

CellFrame make_triangle_cell_frame(uint32_t cell, uint32_t level) {
  CellFrame frame{{0, 0}, 1};
  for (uint32_t k = 1; k <= level; ++k) {
    frame.size *= 0.5f;
    switch (cell_child(cell, k)) {
      case 1:
        frame.origin.x += frame.size;
        break;
      case 2:
        frame.origin.y += frame.size;
        break;
      case 3:
        frame.origin += Vec2(frame.size), frame.size = -frame.size;
        break;
      default:
        break;
    }
  }
  return frame;
}

FaceFrameTable make_face_frames(const FaceTable& faces) {
  FaceFrameTable frames;
  for (size_t f = 0; f < faces.size(); ++f) {
    const auto& corner = faces.corners[f];
    const bool triangle = faces.corner_count[f] == 3;
    const Vec3 u = corner[1] - corner[0], v = corner[triangle ? 2 : 3] - corner[0];
    Vec3 twist = triangle ? Vec3(0) : corner[2] - corner[1] - corner[3] + corner[0];
    // Rounding of the corners alone is no twist.
    const bool affine = triangle || length(twist) <= 1e-6f * (length(u) + length(v));
    if (affine) twist = Vec3(0);
    const DVec3 du(u), dv(v), n = cross(du, dv);
    const double scale = 1 / dot(n, n);
    frames.origin.push_back(corner[0]);
    frames.edge_u.push_back(u);
    frames.edge_v.push_back(v);
    frames.twist.push_back(twist);
    frames.dual_u.push_back(Vec3(cross(dv, n) * scale));
    frames.dual_v.push_back(Vec3(cross(n, du) * scale));
    frames.triangle.push_back(triangle);
    frames.affine.push_back(affine);
  }
  return frames;
}

Vec2 undo_twist(const FaceFrameTable& frames, uint32_t face, Vec2 target) {
  // In the basis (edge_u, edge_v) the bilinear map is (u, v) + u v twist: Newton's method, from the
  // parameters without twist. Convex quads have one root in the unit square and a Jacobian that does not
  // change sign there.
  const Vec3 twist3 = frames.twist[face];
  const Vec2 twist(dot(twist3, frames.dual_u[face]), dot(twist3, frames.dual_v[face]));
  Vec2 uv = {std::clamp(target.x, 0.0f, 1.0f), std::clamp(target.y, 0.0f, 1.0f)};
  for (int step = 0; step < 8; ++step) {
    const Vec2 miss = uv + uv.x * uv.y * twist - target;
    const float a = 1 + uv.y * twist.x, b = uv.x * twist.x, c = uv.y * twist.y, d = 1 + uv.x * twist.y;
    const float determinant = a * d - b * c;
    if (std::abs(determinant) < 1e-12f) break;
    const Vec2 change((d * miss.x - b * miss.y) / determinant, (a * miss.y - c * miss.x) / determinant);
    uv -= change;
    uv = {std::clamp(uv.x, -0.5f, 1.5f), std::clamp(uv.y, -0.5f, 1.5f)};
    if (std::abs(change.x) + std::abs(change.y) < 1e-7f) break;
  }
  return uv;
}

std::array<Vec2, 4> cell_corner_parameters(bool triangle, uint32_t cell, uint32_t level) {
  const auto [origin, size] = make_cell_frame(triangle, cell, level);
  if (triangle) return {origin, origin + Vec2(size, 0), origin + Vec2(0, size), origin + Vec2(0, size)};
  return {origin, origin + Vec2(size, 0), origin + Vec2(size, size), origin + Vec2(0, size)};
}

std::array<Vec3, 4> cell_corners(const FaceFrameTable& frames, uint32_t face, uint32_t cell, uint32_t level) {
  std::array<Vec3, 4> corners;
  const auto parameters = cell_corner_parameters(frames.triangle[face], cell, level);
  for (size_t k = 0; k < 4; ++k) corners[k] = face_point(frames, face, parameters[k]);
  return corners;
}

float cell_area(const FaceFrameTable& frames, uint32_t face, uint32_t cell, uint32_t level) {
  if (frames.affine[face]) {
    const double root = length(cross(DVec3(frames.edge_u[face]), DVec3(frames.edge_v[face])));
    return static_cast<float>((frames.triangle[face] ? root / 2 : root) * cell_size(level) *
                              cell_size(level));
  }
  const auto c = cell_corners(frames, face, cell, level);
  return static_cast<float>(0.5 * length(cross(DVec3(c[2]) - DVec3(c[0]), DVec3(c[3]) - DVec3(c[1]))));
}

float find_scene_scale(const FaceTable& faces, const FaceFrameTable& frames) {
  // A sun or a sky may be as large and as far as it likes: sizes come from what light falls on.
  double lit = 0, all = 0;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const double area = cell_area(frames, f, 0, 0);
    all += area;
    if (largest(faces.reflectance[f]) > 0 || largest(faces.emission[f]) == 0) lit += area;
  }
  return static_cast<float>(std::sqrt(lit > 0 ? lit : all));
}

float longest_edge(const std::array<Vec3, 4>& corners) {
  float longest = 0;
  for (size_t k = 0; k < 4; ++k) longest = std::max(longest, distance(corners[k], corners[(k + 1) % 4]));
  return longest;
}

Vec3 cell_centre(const FaceFrameTable& frames, uint32_t face, uint32_t cell, uint32_t level) {
  const bool triangle = frames.triangle[face];
  const auto [origin, size] = make_cell_frame(triangle, cell, level);
  return face_point(frames, face, origin + Vec2(size * (triangle ? 1 / 3.0f : 0.5f)));
}

}  // namespace patchlight
