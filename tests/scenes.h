// Scenes made in code, in engine lengths, and the few measures that tests of the engine and of the physics
// share.
#pragma once

#include "engine/base/sampling.h"
#include "engine/mesh/quadtree.h"
#include "engine/solve/solve.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace patchlight {

struct Surface {
  Rgb emission{0}, reflectance{0};
};
inline Surface make_surface(float emission, float reflectance) { return {Rgb(emission), Rgb(reflectance)}; }

inline uint32_t next_polygon(const FaceTable& faces) {
  uint32_t next = 0;
  for (const uint32_t polygon : faces.polygon) next = std::max(next, polygon + 1);
  return next;
}

// Adds a triangle or quad, corners counter-clockwise from the lit side, as a part of `polygon`. Returns the
// face.
inline uint32_t add_face(FaceTable& faces, std::span<const Vec3> corners, uint32_t polygon,
                         const Surface& surface) {
  const Vec3 last = corners.back();
  faces.corners.push_back({corners[0], corners[1], corners[2], last});
  faces.corner_count.push_back(static_cast<uint8_t>(corners.size()));
  const DVec3 across = corners.size() == 3
                           ? cross(DVec3(corners[1] - corners[0]), DVec3(corners[2] - corners[0]))
                           : cross(DVec3(corners[2] - corners[0]), DVec3(corners[3] - corners[1]));
  faces.normal.push_back(Vec3(normalize(across)));
  faces.emission.push_back(surface.emission);
  faces.reflectance.push_back(surface.reflectance);
  faces.polygon.push_back(polygon);
  faces.surface.push_back(kNone);
  faces.twin.push_back(kNone);
  faces.patch_size.push_back(0);
  faces.patch_size_min.push_back(0);
  faces.level_min.push_back(0);
  return static_cast<uint32_t>(faces.size() - 1);
}

// These add one polygon and return its index.
inline uint32_t add_quad(FaceTable& faces, Vec3 a, Vec3 b, Vec3 c, Vec3 d, const Surface& surface) {
  const uint32_t polygon = next_polygon(faces);
  add_face(faces, std::array{a, b, c, d}, polygon, surface);
  return polygon;
}
inline uint32_t add_triangle(FaceTable& faces, Vec3 a, Vec3 b, Vec3 c, const Surface& surface) {
  const uint32_t polygon = next_polygon(faces);
  add_face(faces, std::array{a, b, c}, polygon, surface);
  return polygon;
}
// A triangle or quad from its list of corners.
inline uint32_t add_polygon(FaceTable& faces, std::span<const Vec3> corners, const Surface& surface) {
  const uint32_t polygon = next_polygon(faces);
  add_face(faces, corners, polygon, surface);
  return polygon;
}

// Two polygons back to back; returns the first, whose lit side sees the corners counter-clockwise. The other
// follows.
inline uint32_t add_two_sided(FaceTable& faces, std::span<const Vec3> corners, const Surface& front,
                              const Surface& back) {
  const uint32_t polygon = next_polygon(faces);
  const uint32_t first = add_face(faces, corners, polygon, front);
  const std::vector<Vec3> turned(corners.rbegin(), corners.rend());
  const uint32_t second = add_face(faces, turned, polygon + 1, back);
  faces.twin[first] = second, faces.twin[second] = first;
  return polygon;
}

// A polygon of triangles about its centre; the rim runs counter-clockwise from the lit side.
inline uint32_t add_fan(FaceTable& faces, Vec3 centre, std::span<const Vec3> rim, const Surface& surface) {
  const uint32_t polygon = next_polygon(faces);
  for (size_t k = 0; k < rim.size(); ++k)
    add_face(faces, std::array{centre, rim[k], rim[(k + 1) % rim.size()]}, polygon, surface);
  return polygon;
}

// A regular polygon in the plane y = centre.y, lit from above (up = 1) or below (up = -1).
inline std::vector<Vec3> make_ring(Vec3 centre, float radius, uint32_t corner_count, float up) {
  std::vector<Vec3> ring;
  for (uint32_t k = 0; k < corner_count; ++k) {
    const double angle = -up * 2 * std::numbers::pi * k / corner_count;
    ring.push_back(
        centre + radius * Vec3(static_cast<float>(std::cos(angle)), 0, static_cast<float>(std::sin(angle))));
  }
  return ring;
}

// Walls of a box in this order, seen from inside.
enum BoxSide : uint32_t { kFloor, kCeiling, kLeft, kRight, kFront, kBack };
using BoxSurfaces = std::array<Surface, 6>;
inline BoxSurfaces make_box_surfaces(const Surface& all) { return {all, all, all, all, all, all}; }

// Six polygons that look into the box: floor (low y), ceiling, left (low x), right, front (high z), back.
inline uint32_t add_box_inward(FaceTable& faces, Vec3 low, Vec3 high, const BoxSurfaces& surfaces) {
  const uint32_t first = next_polygon(faces);
  const auto at = [&](int x, int y, int z) {
    return Vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  add_quad(faces, at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 0, 0), surfaces[kFloor]);
  add_quad(faces, at(0, 1, 0), at(1, 1, 0), at(1, 1, 1), at(0, 1, 1), surfaces[kCeiling]);
  add_quad(faces, at(0, 0, 0), at(0, 1, 0), at(0, 1, 1), at(0, 0, 1), surfaces[kLeft]);
  add_quad(faces, at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0), surfaces[kRight]);
  add_quad(faces, at(0, 0, 1), at(0, 1, 1), at(1, 1, 1), at(1, 0, 1), surfaces[kFront]);
  add_quad(faces, at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), surfaces[kBack]);
  return first;
}

// Turns a face over.
inline void turn_face(FaceTable& faces, uint32_t face) {
  auto& corner = faces.corners[face];
  if (faces.corner_count[face] == 4) {
    std::swap(corner[1], corner[3]);
  } else {
    std::swap(corner[1], corner[2]);
    corner[3] = corner[2];
  }
  faces.normal[face] = -faces.normal[face];
}

// Six polygons that look out of a solid box, in the same order.
inline uint32_t add_box_outward(FaceTable& faces, Vec3 low, Vec3 high, const Surface& surface) {
  const uint32_t first_face = static_cast<uint32_t>(faces.size());
  const uint32_t first = add_box_inward(faces, low, high, make_box_surfaces(surface));
  for (uint32_t face = first_face; face < faces.size(); ++face) turn_face(faces, face);
  return first;
}

// The part of a sphere between its top pole and polar angle `angle_max`, as conforming planar quads and
// triangles, one polygon each: `stacks` bands of `slices` parts. Lit inside or outside; `surface_of` gets the
// band, 0 at the top.
inline uint32_t add_sphere(FaceTable& faces, Vec3 centre, float radius, uint32_t stacks, uint32_t slices,
                           double angle_max, bool inward,
                           const std::function<Surface(uint32_t)>& surface_of) {
  const uint32_t first = next_polygon(faces);
  const auto at = [&](uint32_t stack, uint32_t slice) {
    const double polar = angle_max * stack / stacks, round = 2 * std::numbers::pi * (slice % slices) / slices;
    const bool bottom = stack == stacks && angle_max == std::numbers::pi;
    const double sine = bottom ? 0 : std::sin(polar);
    return centre +
           Vec3(DVec3(sine * std::cos(round), bottom ? -1.0 : std::cos(polar), sine * std::sin(round)) *
                double{radius});
  };
  for (uint32_t stack = 0; stack < stacks; ++stack)
    for (uint32_t slice = 0; slice < slices; ++slice) {
      const Vec3 a = at(stack, slice), b = at(stack + 1, slice), c = at(stack + 1, slice + 1),
                 d = at(stack, slice + 1);
      const Surface surface = surface_of(stack);
      if (stack == 0) {
        add_triangle(faces, a, b, c, surface);
      } else if (b == c) {
        add_triangle(faces, a, b, d, surface);
      } else {
        add_quad(faces, a, b, c, d, surface);
      }
      // As written the corners run counter-clockwise from inside.
      if (!inward) turn_face(faces, static_cast<uint32_t>(faces.size() - 1));
    }
  return first;
}

inline double face_area(const FaceTable& faces, uint32_t face) {
  const auto& c = faces.corners[face];
  // Half the cross product of the diagonals; a triangle's repeated corner makes it right for both.
  return 0.5 * length(cross(DVec3(c[2]) - DVec3(c[0]), DVec3(c[3]) - DVec3(c[1])));
}

// Moves and scales all corners: p to scale * p + shift.
inline void map_scene(FaceTable& faces, float scale, Vec3 shift) {
  for (auto& corners : faces.corners)
    for (Vec3& p : corners) p = scale * p + shift;
}

// Engine lengths: the square root of the total area becomes 1. Returns the scale.
inline float fit_scene(FaceTable& faces) {
  double area = 0;
  for (uint32_t f = 0; f < faces.size(); ++f) area += face_area(faces, f);
  const auto scale = static_cast<float>(1 / std::sqrt(area));
  map_scene(faces, scale, Vec3(0));
  return scale;
}

// A closed room of three colours, a small lamp under its ceiling and a box on its floor.
inline FaceTable make_furnished_room() {
  FaceTable faces;
  add_box_inward(faces, Vec3(0), Vec3(1), make_box_surfaces({Rgb(0), Rgb(0.7f, 0.5f, 0.2f)}));
  add_quad(faces, {0.35f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.4f}, {0.6f, 0.98f, 0.6f}, {0.35f, 0.98f, 0.6f},
           {Rgb(10, 9, 7), Rgb(0.3f)});
  add_box_outward(faces, {0.2f, 0, 0.3f}, {0.5f, 0.45f, 0.6f}, make_surface(0, 0.6f));
  fit_scene(faces);
  return faces;
}

// One flat polygon of two quads, one of them skewed, and two triangles, whose first corners lie all about.
inline FaceTable make_mixed_polygon(const Surface& surface) {
  FaceTable faces;
  add_face(faces, std::array{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 0, surface);
  add_face(faces, std::array{Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(1.8f, 0.4f, 0)}, 0, surface);
  add_face(faces, std::array{Vec3(0.4f, 1.7f, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)}, 0, surface);
  add_face(faces, std::array{Vec3(0, 1, 0), Vec3(-0.6f, 0.8f, 0), Vec3(-0.8f, 0.1f, 0), Vec3(0, 0, 0)}, 0,
           surface);
  return faces;
}

// Splits about a fifth of the leaves, and what balance asks for, `rounds` times.
inline void split_at_random(PatchTable& leaves, const FaceFrameTable& frames, const FaceLinkTable& links,
                            uint32_t rounds, uint64_t seed) {
  for (uint32_t round = 0; round < rounds; ++round) {
    std::vector<uint8_t> marks(leaves.size());
    for (uint32_t row = 0; row < leaves.size(); ++row)
      marks[row] = make_jitter(seed + round, row).x < 0.2f && leaves.level[row] < kLevelMax - 1;
    mark_for_balance(marks, leaves, frames, links);
    std::vector<uint32_t> parent;
    leaves = split_leaves(leaves, frames, marks, parent);
  }
}

// The same in every column.
template <typename Table>
bool is_equal(const Table& a, const Table& b) {
  bool equal = true;
  for_each_column([&](const char*, const auto& x, const auto& y) { equal &= x == y; }, a, b);
  return equal;
}

// The mesh of a scene with all its rounds, and `pass_count` passes.
inline Solution solve_scene(const FaceTable& faces, const SolverSettings& settings, uint32_t pass_count,
                            const Sky& sky = {}) {
  Solution solution = make_solution(make_surfaces(faces, sky), settings);
  while (refine(solution)) {
  }
  while (solution.log.passes.size() < pass_count) advance(solution);
  return solution;
}

inline void advance_to(Solution& solution, uint32_t pass) {
  while (solution.log.passes.size() < pass) advance(solution);
}

// Sums over the elements of the polygons [first, last): exposed area times a column.
template <typename Column>
DRgb polygon_power(const Solution& s, const FaceTable& faces, uint32_t first, uint32_t last,
                   const Column& column) {
  DRgb sum(0);
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    const uint32_t polygon = faces.polygon[s.mesh.elements.face[row]];
    if (polygon >= first && polygon < last)
      sum += double{s.mesh.elements.area[row]} * s.mesh.elements.exposed[row] * DRgb(column[row]);
  }
  return sum;
}
inline double exposed_area(const Solution& s, const FaceTable& faces, uint32_t first, uint32_t last) {
  return polygon_power(s, faces, first, last, std::vector<Rgb>(s.mesh.elements.size(), Rgb(1))).g;
}

// Mean green radiosity over the exposed area of the polygons [first, last), or of one.
inline double mean_radiosity(const Solution& s, const FaceTable& faces, uint32_t first, uint32_t last) {
  return polygon_power(s, faces, first, last, s.mesh.elements.radiosity).g /
         exposed_area(s, faces, first, last);
}
inline double mean_radiosity(const Solution& s, const FaceTable& faces, uint32_t polygon) {
  return mean_radiosity(s, faces, polygon, polygon + 1);
}

}  // namespace patchlight
