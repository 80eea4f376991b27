// Faces joined to planar parts: outlines without seams, few convex pieces, a hull.
#include "engine/factors/parts.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <unordered_map>

namespace patchlight {
namespace {

// A polygon whose corners lie no further off one plane than this share of its size is flat: the loader leaves
// quads whole up to there, too.
constexpr double kFlat = 2e-6;
// How far from a plane a point may be, as a share of its coordinates, and still lie in it: a few units in the
// last place of floats; of doubles, after turns and moves.
constexpr double kTouchFloat = 1e-6;
constexpr double kTouchFine = 4e-15;
// Coordinates below this one, in lengths, count as this one where they are floats: rays go by floats, and
// start so far from where they are made.
constexpr double kFloatCoordinateMin = 0.25;
// Sine of the turn up to which an edge goes on straight.
constexpr double kStraight = 1e-6;

using Ring = std::vector<uint32_t>;  // corners, by their number among the part's points

// The corners of some faces, each place once.
struct Corners {
  std::vector<DVec3> points;
  std::vector<Ring> rings;  // a row a face
};

Corners number_corners(const FaceTable& faces, const PartTable& parts, uint32_t first, uint32_t last) {
  Corners corners;
  const auto is_before = [](const DVec3& a, const DVec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  for (uint32_t face = first; face < last; ++face)
    for (int k = 0; k < faces.corner_count[face]; ++k) corners.points.push_back(parts.face_corners[face][k]);
  std::sort(corners.points.begin(), corners.points.end(), is_before);
  corners.points.erase(std::unique(corners.points.begin(), corners.points.end()), corners.points.end());
  for (uint32_t face = first; face < last; ++face) {
    Ring& ring = corners.rings.emplace_back();
    for (int k = 0; k < faces.corner_count[face]; ++k) {
      const DVec3 p = parts.face_corners[face][k];
      const auto at = std::lower_bound(corners.points.begin(), corners.points.end(), p, is_before);
      const auto index = static_cast<uint32_t>(at - corners.points.begin());
      if (ring.empty() || (ring.back() != index && ring.front() != index)) ring.push_back(index);
    }
  }
  return corners;
}

uint64_t edge_key(uint32_t from, uint32_t to) { return uint64_t{from} << 32 | to; }

// The sine of the turn at b; above 0 to the left.
double find_turn(DVec3 a, DVec3 b, DVec3 c, DVec3 normal) {
  const DVec3 in = b - a, out = c - b;
  const double lengths = std::sqrt(dot(in, in) * dot(out, out));
  return lengths > 0 ? dot(cross(in, out), normal) / lengths : 0;
}

// Takes corners out of a ring at which it goes on straight.
void drop_straight_corners(Ring& ring, const std::vector<DVec3>& points, DVec3 normal) {
  for (size_t k = 0; k < ring.size() && ring.size() > 3;) {
    const DVec3 a = points[ring[(k + ring.size() - 1) % ring.size()]], b = points[ring[k]],
                c = points[ring[(k + 1) % ring.size()]];
    if (std::abs(find_turn(a, b, c, normal)) <= kStraight && dot(b - a, c - b) > 0)
      ring.erase(ring.begin() + static_cast<ptrdiff_t>(k));
    else
      ++k;
  }
}

// The edges of the rings that no other runs along the other way, straight ones joined.
std::vector<Segment> find_outline(const Corners& corners, DVec3 normal) {
  std::unordered_map<uint64_t, uint32_t> count;
  for (const Ring& ring : corners.rings)
    for (size_t k = 0; k < ring.size(); ++k) ++count[edge_key(ring[k], ring[(k + 1) % ring.size()])];
  // Edges by where they start; a corner where the outline touches itself starts two.
  std::unordered_multimap<uint32_t, uint32_t> next;
  std::vector<std::array<uint32_t, 2>> edges;
  for (const Ring& ring : corners.rings)
    for (size_t k = 0; k < ring.size(); ++k) {
      const uint32_t a = ring[k], b = ring[(k + 1) % ring.size()];
      if (count.contains(edge_key(b, a))) continue;
      next.emplace(a, static_cast<uint32_t>(edges.size()));
      edges.push_back({a, b});
    }
  std::vector<uint8_t> taken(edges.size(), 0);
  std::vector<Segment> outline;
  for (uint32_t start = 0; start < edges.size(); ++start) {
    Ring ring;
    for (uint32_t at = start; at != kNone && !taken[at];) {
      taken[at] = 1;
      ring.push_back(edges[at][0]);
      const auto [low, high] = next.equal_range(edges[at][1]);
      at = kNone;
      for (auto k = low; k != high; ++k)
        if (!taken[k->second]) at = at == kNone ? k->second : std::min(at, k->second);
    }
    drop_straight_corners(ring, corners.points, normal);
    for (size_t k = 0; k < ring.size(); ++k)
      outline.push_back({corners.points[ring[k]], corners.points[ring[(k + 1) % ring.size()]]});
  }
  return outline;
}

// The ring around two that share the edge from a to b of the first.
Ring join_rings(const Ring& first, const Ring& second, uint32_t a, uint32_t b) {
  Ring joined;
  const auto append = [&](const Ring& ring, uint32_t from, uint32_t to) {
    size_t k = static_cast<size_t>(std::find(ring.begin(), ring.end(), from) - ring.begin());
    for (; ring[k] != to; k = (k + 1) % ring.size()) joined.push_back(ring[k]);
  };
  append(first, b, a);
  append(second, a, b);
  return joined;
}

bool is_convex(const Ring& ring, const std::vector<DVec3>& points, DVec3 normal) {
  for (size_t k = 0; k < ring.size(); ++k)
    if (find_turn(points[ring[(k + ring.size() - 1) % ring.size()]], points[ring[k]],
                  points[ring[(k + 1) % ring.size()]], normal) < -kStraight)
      return false;
  return true;
}

// Joins neighbouring rings for as long as the result is convex. (Hertel, Mehlhorn: Fast Triangulation of
// Simple Polygons, 1983, do so with triangles.)
void join_convex(std::vector<Ring>& rings, const std::vector<DVec3>& points, DVec3 normal) {
  std::unordered_map<uint64_t, uint32_t> owner;
  const auto enter = [&](uint32_t r) {
    for (size_t k = 0; k < rings[r].size(); ++k)
      owner[edge_key(rings[r][k], rings[r][(k + 1) % rings[r].size()])] = r;
  };
  const auto leave = [&](uint32_t r) {
    for (size_t k = 0; k < rings[r].size(); ++k)
      owner.erase(edge_key(rings[r][k], rings[r][(k + 1) % rings[r].size()]));
  };
  for (uint32_t r = 0; r < rings.size(); ++r) enter(r);
  // A ring that has grown is looked at again, and its neighbours may now fit it.
  for (bool changed = true; changed;) {
    changed = false;
    for (uint32_t r = 0; r < rings.size(); ++r)
      for (size_t k = 0; k < rings[r].size(); ++k) {
        const uint32_t a = rings[r][k], b = rings[r][(k + 1) % rings[r].size()];
        const auto other = owner.find(edge_key(b, a));
        if (other == owner.end() || other->second == r) continue;
        const uint32_t s = other->second;
        stop_if_cancelled();
        Ring joined = join_rings(rings[r], rings[s], a, b);
        drop_straight_corners(joined, points, normal);
        if (!is_convex(joined, points, normal)) continue;
        leave(r), leave(s);
        rings[r] = std::move(joined), rings[s].clear();
        enter(r);
        changed = true;
        k = static_cast<size_t>(-1);
      }
  }
  std::erase_if(rings, [](const Ring& ring) { return ring.empty(); });
}

void push_hull(PartTable& parts, std::span<const Segment> outline, size_t piece_count,
               const HalfSpace& front) {
  std::vector<DVec3> points, hull;
  for (const Segment& segment : outline) points.push_back(segment.start);
  set_hull(hull, points, piece_count == 1, front.normal);
  // A rectangle around them lies in the plane, however far its first corner is off it.
  if (piece_count != 1 || points.size() > kHullCornersMax)
    for (DVec3& p : hull) p -= height_above(front, p) * front.normal;
  parts.hull.insert(parts.hull.end(), hull.begin(), hull.end());
  parts.convex.push_back(piece_count == 1 && points.size() <= kHullCornersMax);
  parts.hull_first.push_back(static_cast<uint32_t>(parts.hull.size()));
}

struct Plane {
  DVec3 normal, centre;
  double area = 0, off_plane = 0, radius = 0;
};

// The mean plane of some faces.
Plane find_plane(const FaceTable& faces, const PartTable& parts, uint32_t first, uint32_t last) {
  Plane plane{};
  DVec3 normal(0), low(1e300), high(-1e300);
  for (uint32_t face = first; face < last; ++face) {
    const auto& c = parts.face_corners[face];
    const DVec3 across = 0.5 * cross(c[2] - c[0], c[3] - c[1]);
    normal += across, plane.area += length(across);
    for (const DVec3& p : c) low = min(low, p), high = max(high, p);
  }
  plane.normal = dot(normal, normal) > 0 ? normalize(normal) : DVec3(faces.normal[first]);
  plane.centre = 0.5 * (low + high);
  double height_min = 1e300, height_max = -1e300;
  for (uint32_t face = first; face < last; ++face)
    for (const DVec3& p : parts.face_corners[face]) {
      const DVec3 way = p - plane.centre;
      plane.radius = std::max(plane.radius, length(way));
      height_min = std::min(height_min, dot(way, plane.normal));
      height_max = std::max(height_max, dot(way, plane.normal));
    }
  plane.off_plane = 0.5 * (height_max - height_min);
  // The centre is that of a box, which need not lie in the plane.
  plane.centre += 0.5 * (height_min + height_max) * plane.normal;
  return plane;
}

void push_rounding(PartTable& parts, std::span<const DVec3> points, const FineCorners& fine) {
  double most = 0;
  for (const DVec3& p : points) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const bool is_fine = !fine.corners.empty();
  const double touch = is_fine ? kTouchFine * most : kTouchFloat * std::max(most, kFloatCoordinateMin);
  parts.touch.push_back(touch + parts.off_plane.back());
  parts.rounding.push_back(is_fine ? 0x1p-53 * most : 0);
}

void push_part(PartTable& parts, const FaceTable& faces, const FineCorners& fine, uint32_t first,
               uint32_t last, const Plane& plane) {
  Corners corners = number_corners(faces, parts, first, last);
  const std::vector<Segment> outline = find_outline(corners, plane.normal);
  if (corners.rings.size() > 1) join_convex(corners.rings, corners.points, plane.normal);
  parts.polygon.push_back(faces.polygon[first]);
  parts.front.push_back({plane.normal, dot(plane.normal, plane.centre)});
  parts.area.push_back(plane.area);
  parts.centre.push_back(plane.centre);
  parts.radius.push_back(plane.radius + plane.off_plane);
  parts.off_plane.push_back(plane.off_plane);
  push_rounding(parts, corners.points, fine);
  parts.outline.insert(parts.outline.end(), outline.begin(), outline.end());
  parts.outline_first.push_back(static_cast<uint32_t>(parts.outline.size()));
  push_hull(parts, outline, corners.rings.size(), parts.front.back());
  for (const Ring& ring : corners.rings) {
    for (const uint32_t k : ring) parts.piece_corner.push_back(corners.points[k]);
    parts.piece_corner_first.push_back(static_cast<uint32_t>(parts.piece_corner.size()));
  }
  parts.piece_first.push_back(static_cast<uint32_t>(parts.piece_corner_first.size() - 1));
  for (uint32_t face = first; face < last; ++face)
    parts.part_of_face[face] = static_cast<uint32_t>(parts.size() - 1);
}

}  // namespace

void set_hull(std::vector<DVec3>& hull, std::span<const DVec3> points, bool convex, DVec3 normal) {
  hull.clear();
  if (convex && points.size() <= kHullCornersMax) {
    hull.assign(points.begin(), points.end());
    return;
  }
  // A rectangle whose sides follow the longest way from one point to the next.
  DVec3 side(0);
  for (size_t k = 0; k < points.size(); ++k) {
    const DVec3 step = points[(k + 1) % points.size()] - points[k];
    if (dot(step, step) > dot(side, side)) side = step;
  }
  side -= dot(side, normal) * normal;
  const DVec3 base = points[0], u = normalize(side), v = cross(normal, u);
  double u_min = 0, u_max = 0, v_min = 0, v_max = 0;
  for (const DVec3& point : points) {
    const DVec3 p = point - base;
    u_min = std::min(u_min, dot(p, u)), u_max = std::max(u_max, dot(p, u));
    v_min = std::min(v_min, dot(p, v)), v_max = std::max(v_max, dot(p, v));
  }
  hull = {base + u_min * u + v_min * v, base + u_max * u + v_min * v, base + u_max * u + v_max * v,
          base + u_min * u + v_max * v};
}

PartTable make_parts(const FaceTable& faces, size_t polygon_count, const FineCorners& fine) {
  assert(std::is_sorted(faces.polygon.begin(), faces.polygon.end()));
  PartTable parts;
  parts.part_of_face.resize(faces.size());
  parts.face_corners = fine.corners, parts.shift = fine.shift;
  if (fine.corners.empty())
    for (const auto& c : faces.corners)
      parts.face_corners.push_back({DVec3(c[0]), DVec3(c[1]), DVec3(c[2]), DVec3(c[3])});
  for (auto* first : {&parts.outline_first, &parts.hull_first, &parts.piece_first, &parts.piece_corner_first,
                      &parts.polygon_first})
    first->assign(1, 0);
  uint32_t face = 0;
  for (uint32_t polygon = 0; polygon < polygon_count; ++polygon) {
    stop_if_cancelled();
    const uint32_t first = face;
    while (face < faces.size() && faces.polygon[face] == polygon) ++face;
    if (first < face) {
      const Plane plane = find_plane(faces, parts, first, face);
      if (face - first == 1 || plane.off_plane <= kFlat * 2 * plane.radius)
        push_part(parts, faces, fine, first, face, plane);
      else
        for (uint32_t f = first; f < face; ++f)
          push_part(parts, faces, fine, f, f + 1, find_plane(faces, parts, f, f + 1));
    }
    parts.polygon_first.push_back(static_cast<uint32_t>(parts.size()));
  }
  assert(face == faces.size());
  return parts;
}

}  // namespace patchlight
