// Chooses how a polygon is cut, and cuts quads and general polygons.
#include "dsl/polygons/cut.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kAspectMax = 1.5;   // longer quads are cut into near squares
constexpr double kAspectMaxFew = 4;  // lamps and meshes only above this, into pieces of about this
constexpr size_t kPiecesMax = 1024;
constexpr size_t kPiecesMaxMesh = 8;

std::array<DVec2, 4> flat_quad(const FlatPolygon& polygon) {
  return {polygon.flat[0], polygon.flat[1], polygon.flat[2], polygon.flat[3]};
}

void cut_at_diagonal(const FlatPolygon& polygon, CutFaces& cut) {
  const std::array<DVec2, 4> q = flat_quad(polygon);
  // Of the diagonals that lie inside (both, when convex) the shorter one gives the better triangles.
  const bool inside_02 = turn(q[0], q[1], q[2]) > 0 && turn(q[0], q[2], q[3]) > 0;
  const bool inside_13 = turn(q[1], q[2], q[3]) > 0 && turn(q[1], q[3], q[0]) > 0;
  const bool shorter_02 = glm::length(q[2] - q[0]) <= glm::length(q[3] - q[1]) * (1 + 1e-12);
  if (inside_02 && (shorter_02 || !inside_13))
    cut.faces = {{0, 1, 2, 2}, {0, 2, 3, 3}};
  else
    cut.faces = {{0, 1, 3, 3}, {1, 2, 3, 3}};
}

// A quad, whole or as a row of pieces along its long side.
void cut_quad(const FlatPolygon& polygon, bool few, CutFaces& cut) {
  const std::array<DVec2, 4> q = flat_quad(polygon);
  const double length = (glm::length(q[1] - q[0]) + glm::length(q[2] - q[3])) / 2;
  const double width = (glm::length(q[2] - q[1]) + glm::length(q[3] - q[0])) / 2;
  const double aspect = std::max(length, width) / std::min(length, width);
  size_t pieces = 1;
  if (few && aspect > kAspectMaxFew)
    pieces = static_cast<size_t>(std::ceil(std::min(aspect, 1e6) / kAspectMaxFew));
  if (!few && aspect > kAspectMax) pieces = static_cast<size_t>(std::lround(std::min(aspect, 1e6)));
  pieces = std::min(pieces, polygon.of_mesh ? kPiecesMaxMesh : kPiecesMax);
  // Corners 0, 1 and 3, 2 are the ends of the two long sides.
  std::array<uint32_t, 4> corner = {0, 1, 2, 3};
  if (width > length) corner = {1, 2, 3, 0};
  const auto count = static_cast<double>(pieces);
  uint32_t low = corner[0], high = corner[3];
  for (size_t k = 1; k <= pieces; ++k) {
    uint32_t low_next = corner[1], high_next = corner[2];
    if (k < pieces) {
      const double t = static_cast<double>(k) / count;
      low_next = static_cast<uint32_t>(cut.points.size());
      high_next = low_next + 1;
      cut.points.push_back(glm::mix(polygon.points[corner[0]], polygon.points[corner[1]], t));
      cut.points.push_back(glm::mix(polygon.points[corner[3]], polygon.points[corner[2]], t));
    }
    cut.faces.push_back({low, low_next, high_next, high});
    low = low_next;
    high = high_next;
  }
}

}  // namespace

bool cut_polygon(const FlatPolygon& polygon, bool emits, CutFaces& cut) {
  cut.points = polygon.points;
  cut.faces.clear();
  const bool flat_enough = polygon.off_plane <= kQuadFlatMax && !polygon.only_triangles;
  const bool one_ring = polygon.ring_count() == 1;
  const bool few = emits || polygon.of_mesh;
  if (one_ring && polygon.points.size() == 3) {
    cut.faces.push_back({0, 1, 2, 2});
    return true;
  }
  if (one_ring && polygon.points.size() == 4) {
    const double ratio = jacobian_ratio(flat_quad(polygon));
    if (flat_enough && ratio <= kJacobianRatioMax)
      cut_quad(polygon, few, cut);
    else
      cut_at_diagonal(polygon, cut);
    return true;
  }
  if (flat_enough && !few && cut_grid(polygon, cut)) return true;
  std::vector<DVec2> flat;
  if (flat_enough && !emits && cut_rings(polygon, flat, cut)) {
    flip_to_delaunay(flat, cut.faces);
    merge_to_quads(flat, cut.faces);
    return true;
  }
  if (!triangulate(polygon, cut.faces)) return false;
  flip_to_delaunay(polygon.flat, cut.faces);
  if (flat_enough) merge_to_quads(polygon.flat, cut.faces);
  return true;
}

}  // namespace patchlight
