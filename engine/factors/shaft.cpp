// The hull of two convex polygons as half-spaces, and the faces that reach into it.
#include "engine/factors/shaft.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace patchlight {
namespace {

constexpr size_t kFacesPerLeaf = 4;
// Half-spaces of a shaft; more are left out, which makes it wider.
constexpr size_t kSidesMax = 40;
// Faces that are still looked at once there is doubt, for one that hides all.
constexpr uint32_t kTriedMax = 16;
// The slack of a shaft is at most this share of its narrower end.
constexpr double kSlackOfEnd = 0.005;
// Of a ray's way, and of a triangle's sides: what rounding may leave.
constexpr double kRayRounding = 1e-10;

uint32_t make_node(Bvh& tree, const PartTable& parts, const std::vector<DVec3>& centre, uint32_t first,
                   uint32_t last) {
  const auto node = static_cast<uint32_t>(tree.first.size());
  DVec3 low(1e300), high(-1e300), centre_low(1e300), centre_high(-1e300);
  for (uint32_t k = first; k < last; ++k) {
    for (const DVec3& p : parts.face_corners[tree.face[k]]) low = min(low, p), high = max(high, p);
    centre_low = min(centre_low, centre[tree.face[k]]), centre_high = max(centre_high, centre[tree.face[k]]);
  }
  tree.low.push_back(low), tree.high.push_back(high);
  tree.first.push_back(first), tree.count.push_back(last - first), tree.second.push_back(kNone);
  if (last - first <= kFacesPerLeaf) return node;
  const DVec3 size = centre_high - centre_low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = (first + last) / 2;
  const auto at = [&](uint32_t k) { return tree.face.begin() + k; };
  std::nth_element(at(first), at(middle), at(last), [&](uint32_t a, uint32_t b) {
    return centre[a][axis] != centre[b][axis] ? centre[a][axis] < centre[b][axis] : a < b;
  });
  make_node(tree, parts, centre, first, middle);
  const uint32_t second = make_node(tree, parts, centre, middle, last);
  tree.second[node] = second;
  return node;
}

// The hull of two convex polygons, shrunk by the slack: points with dot(normal, p) >= height for all sides.
struct Shaft {
  DVec3 low, high;
  double size;      // of the box, lengths
  double rounding;  // of heights, lengths
  std::array<HalfSpace, kSidesMax> sides;
  size_t side_count = 0;
};

void add_side(Shaft& shaft, DVec3 normal, double height) {
  // Two parallel edges give the same plane four times.
  for (size_t k = 0; k < shaft.side_count; ++k)
    if (dot(shaft.sides[k].normal, normal) > 1 - 1e-14 &&
        std::abs(shaft.sides[k].height - height) < 1e-12 * shaft.size)
      return;
  if (shaft.side_count < kSidesMax) shaft.sides[shaft.side_count++] = {normal, height};
}

// Planes through an edge of the one polygon and a corner of the other with both polygons on one side.
void add_sides(Shaft& shaft, std::span<const DVec3> edges_of, std::span<const DVec3> corners_of,
               double slack) {
  for (size_t k = 0; k < edges_of.size(); ++k) {
    const DVec3 a = edges_of[k], edge = edges_of[(k + 1) % edges_of.size()] - a;
    for (const DVec3& corner : corners_of) {
      DVec3 normal = cross(edge, corner - a);
      const double size = length(normal);
      if (size <= 1e-9 * std::sqrt(dot(edge, edge) * dot(corner - a, corner - a))) continue;
      normal /= size;
      double least = 0, most = 0;
      const double bound = 1e-12 * shaft.size + shaft.rounding;
      for (const auto& points : {edges_of, corners_of})
        for (const DVec3& p : points) {
          const double height = dot(normal, p - a);
          least = std::min(least, height), most = std::max(most, height);
          if (least < -bound && most > bound) break;
        }
      if (least >= -bound) add_side(shaft, normal, dot(normal, a) + slack);
      if (most <= bound) add_side(shaft, -normal, -dot(normal, a) + slack);
    }
  }
}

// A length across a polygon: the square root of its area, or less where it is a sliver.
double find_width(std::span<const DVec3> corners) {
  DVec3 across(0);
  double longest = 0;
  for (size_t k = 0; k < corners.size(); ++k) {
    const DVec3 a = corners[k] - corners[0], b = corners[(k + 1) % corners.size()] - corners[0];
    across += 0.5 * cross(a, b);
    longest = std::max(longest, length(a));
  }
  return longest > 0 ? length(across) / longest : 0;
}

// Where rounding may have moved the corners of what only touches the shaft.
double find_slack(const PartTable& parts, const ShaftEnd& a, const ShaftEnd& b) {
  const double touch = 0.5 * std::max(parts.touch[a.part], parts.touch[b.part]);
  return std::min(touch, kSlackOfEnd * std::min(find_width(a.hull), find_width(b.hull)));
}

bool is_outside(const Shaft& shaft, DVec3 low, DVec3 high) {
  for (int axis = 0; axis < 3; ++axis)
    if (low[axis] > shaft.high[axis] || high[axis] < shaft.low[axis]) return true;
  const DVec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
  for (size_t k = 0; k < shaft.side_count; ++k) {
    const auto& [normal, height] = shaft.sides[k];
    if (dot(normal, middle) + dot(abs(normal), half) < height) return true;
  }
  return false;
}

// Is anything of the face left when it is clipped at all sides? Its corners may lie off its plane by `slack`.
bool reaches_into(const Shaft& shaft, const FaceTable& faces, const PartTable& parts, uint32_t face) {
  const double slack = parts.off_plane[parts.part_of_face[face]];
  std::array<DVec3, 4 + kSidesMax> corners, kept;
  std::array<double, 4 + kSidesMax> height;
  size_t count = faces.corner_count[face];
  for (size_t k = 0; k < count; ++k) corners[k] = parts.face_corners[face][k];
  for (size_t side = 0; side < shaft.side_count; ++side) {
    size_t inside = 0;
    for (size_t k = 0; k < count; ++k)
      inside += (height[k] = height_above(shaft.sides[side], corners[k]) - slack) >= 0;
    if (inside == 0) return false;
    if (inside == count) continue;
    size_t kept_count = 0;
    for (size_t k = 0; k < count; ++k) {
      const size_t next = k + 1 == count ? 0 : k + 1;
      if (height[k] >= 0) kept[kept_count++] = corners[k];
      if ((height[k] >= 0) != (height[next] >= 0))
        kept[kept_count++] =
            corners[k] + (height[k] / (height[k] - height[next])) * (corners[next] - corners[k]);
    }
    std::swap(corners, kept);
    count = kept_count;
  }
  return true;
}

// Does the convex part stand between all of a and all of b? Where every line from a corner of the one to a
// corner of the other passes through it, all lines do: where any line meets its plane is a mean, with weights
// above zero, of where those lines do.
bool hides(const PartTable& parts, uint32_t part, const ShaftEnd& a, const ShaftEnd& b, double slack) {
  const auto corners = part_hull(parts, part);
  const HalfSpace& front = parts.front[part];
  std::array<double, 2 * kHullCornersMax> height_a, height_b;
  double sum_a = 0, sum_b = 0;
  for (size_t k = 0; k < a.hull.size(); ++k) sum_a += height_a[k] = height_above(front, a.hull[k]);
  for (size_t k = 0; k < b.hull.size(); ++k) sum_b += height_b[k] = height_above(front, b.hull[k]);
  if (sum_a * sum_b >= 0) return false;
  const double sign = sum_a > 0 ? 1 : -1;
  for (size_t k = 0; k < a.hull.size(); ++k)
    if (sign * height_a[k] < -slack) return false;
  for (size_t k = 0; k < b.hull.size(); ++k)
    if (sign * height_b[k] > slack) return false;
  for (size_t i = 0; i < a.hull.size(); ++i)
    for (size_t j = 0; j < b.hull.size(); ++j) {
      const double drop = height_a[i] - height_b[j];
      if (std::abs(drop) <= 4 * slack) return false;
      const DVec3 p = a.hull[i] + height_a[i] / drop * (b.hull[j] - a.hull[i]);
      for (size_t k = 0; k < corners.size(); ++k) {
        const DVec3 edge = corners[(k + 1) % corners.size()] - corners[k];
        if (dot(cross(front.normal, edge), p - corners[k]) < -slack * length(edge)) return false;
      }
    }
  return true;
}

// Does the line from `from` by `way` pass beside a box? A share of the way is added for rounding.
bool misses_box(DVec3 low, DVec3 high, DVec3 from, DVec3 way) {
  double first = 0, last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return true;
      continue;
    }
    const double a = (low[axis] - from[axis]) / way[axis], b = (high[axis] - from[axis]) / way[axis];
    first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
  }
  return first > last + kRayRounding;
}

// Does the triangle cross the way between its ends? Both of its borders and its corners count as it. (Moller,
// Trumbore: Fast, Minimum Storage Ray/Triangle Intersection, 1997.)
bool crosses_triangle(DVec3 a, DVec3 b, DVec3 c, DVec3 from, DVec3 way) {
  const DVec3 side = b - a, other = c - a, start = from - a;
  const DVec3 across = cross(way, other);
  const double volume = dot(side, across);
  if (volume == 0) return false;
  const double u = dot(start, across) / volume;
  if (u < -kRayRounding || u > 1 + kRayRounding) return false;
  const DVec3 turned = cross(start, side);
  const double v = dot(way, turned) / volume;
  if (v < -kRayRounding || u + v > 1 + kRayRounding) return false;
  const double t = dot(other, turned) / volume;
  return t > kRayRounding && t < 1 - kRayRounding;
}

}  // namespace

Bvh make_bvh(const FaceTable& faces, const PartTable& parts) {
  Bvh tree;
  std::vector<DVec3> centre(faces.size());
  for (uint32_t face = 0; face < faces.size(); ++face) {
    for (const DVec3& p : parts.face_corners[face]) centre[face] += 0.25 * p;
    if (faces.twin[face] == kNone || faces.twin[face] > face) tree.face.push_back(face);
  }
  if (!tree.face.empty()) make_node(tree, parts, centre, 0, static_cast<uint32_t>(tree.face.size()));
  return tree;
}

Sight find_sight(Blockers& blockers, const Bvh& tree, const FaceTable& faces, const PartTable& parts,
                 const ShaftEnd& a, const ShaftEnd& b) {
  blockers.count = 0;
  assert(a.hull.size() <= 2 * kHullCornersMax);
  assert(b.hull.size() <= 2 * kHullCornersMax);
  if (a.hull.size() < 3 || b.hull.size() < 3 || tree.face.empty()) return Sight::kClear;
  const double slack = find_slack(parts, a, b);
  Shaft shaft;
  shaft.low = DVec3(1e300), shaft.high = DVec3(-1e300);
  for (const auto* end : {&a, &b})
    for (const DVec3& p : end->hull) shaft.low = min(shaft.low, p), shaft.high = max(shaft.high, p);
  const DVec3 most = max(abs(shaft.low), abs(shaft.high));
  shaft.size = length(shaft.high - shaft.low);
  shaft.rounding = 1e-15 * std::max({most.x, most.y, most.z});
  shaft.low += slack, shaft.high -= slack;
  for (const auto* end : {&a, &b})
    add_side(shaft, parts.front[end->part].normal, parts.front[end->part].height + slack);
  // The other sides are seldom needed: most shafts have nothing near them.
  bool has_all_sides = false;
  Sight sight = Sight::kClear;
  uint32_t part_last = kNone, tried = 0;
  std::array<uint32_t, 64> stack;
  size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const uint32_t node = stack[--depth];
    if (is_outside(shaft, tree.low[node], tree.high[node])) continue;
    if (tree.second[node] != kNone) {
      assert(depth + 2 <= stack.size());
      stack[depth++] = tree.second[node], stack[depth++] = node + 1;
      continue;
    }
    if (!has_all_sides) {
      add_sides(shaft, a.hull, b.hull, slack);
      add_sides(shaft, b.hull, a.hull, slack);
      has_all_sides = true;
      if (is_outside(shaft, tree.low[node], tree.high[node])) continue;
    }
    for (uint32_t k = tree.first[node]; k < tree.first[node] + tree.count[node]; ++k) {
      const uint32_t face = tree.face[k], part = parts.part_of_face[face];
      if (part == a.part || part == b.part) continue;
      // What stands for the back of one of the two is in its place.
      if (const uint32_t twin = faces.twin[face]; twin != kNone) {
        const uint32_t back = parts.part_of_face[twin];
        if (back == a.part || back == b.part) continue;
      }
      if (sight == Sight::kMixed && (part == part_last || !parts.convex[part])) continue;
      if (sight == Sight::kMixed && ++tried > kTriedMax) return sight;
      if (!reaches_into(shaft, faces, parts, face)) continue;
      sight = Sight::kMixed;
      if (blockers.count < blockers.face.size()) blockers.face[blockers.count++] = face;
      if (part == part_last || !parts.convex[part]) continue;
      part_last = part;
      if (hides(parts, part, a, b, slack)) return Sight::kHidden;
    }
  }
  return sight;
}

bool is_blocked(const Bvh& tree, const FaceTable& faces, const PartTable& parts, uint32_t part_a,
                uint32_t part_b, DVec3 from, DVec3 to) {
  if (tree.face.empty()) return false;
  const DVec3 way = to - from;
  std::array<uint32_t, 64> stack;
  size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const uint32_t node = stack[--depth];
    if (misses_box(tree.low[node], tree.high[node], from, way)) continue;
    if (tree.second[node] != kNone) {
      assert(depth + 2 <= stack.size());
      stack[depth++] = tree.second[node], stack[depth++] = node + 1;
      continue;
    }
    for (uint32_t k = tree.first[node]; k < tree.first[node] + tree.count[node]; ++k) {
      const uint32_t face = tree.face[k], part = parts.part_of_face[face];
      if (part == part_a || part == part_b) continue;
      if (const uint32_t twin = faces.twin[face]; twin != kNone) {
        const uint32_t back = parts.part_of_face[twin];
        if (back == part_a || back == part_b) continue;
      }
      const auto& c = parts.face_corners[face];
      if (crosses_triangle(c[0], c[1], faces.corner_count[face] == 3 ? c[2] : c[3], from, way)) return true;
      if (faces.corner_count[face] == 4 && crosses_triangle(c[1], c[2], c[3], from, way)) return true;
    }
  }
  return false;
}

}  // namespace patchlight
