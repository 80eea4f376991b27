// Do the rings of a flat polygon cross or touch? Sweep over edges in order of their low x.
#include "dsl/polygons/ring_check.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kContact = 1e-9;  // distances below are contact, in units of the polygon's size

struct Edge {
  DVec2 a, b;
  DVec2 low, high;
  uint32_t ring, corner;  // corner: of `a`, in the polygon's points
};

double distance_to_segment(DVec2 p, DVec2 a, DVec2 b) {
  const DVec2 ab = b - a;
  const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
  return glm::length(p - a - ab * t);
}

// Edges that follow each other share a corner; they are at fault only when they run back over each other.
bool folds_back(const Edge& first, const Edge& second) {
  const DVec2 before = first.a - first.b, after = second.b - second.a;
  if (glm::dot(before, after) <= 0) return false;
  return distance_to_segment(second.b, first.a, first.b) < kContact ||
         distance_to_segment(first.a, second.a, second.b) < kContact;
}

bool touch(const Edge& e, const Edge& f) {
  const double e_a = turn(f.a, f.b, e.a), e_b = turn(f.a, f.b, e.b);
  // No part of an edge is nearer to the other's line than its ends, where both lie on one side. Edges are not
  // longer than 1.
  if (std::min(e_a, e_b) > kContact || std::max(e_a, e_b) < -kContact) return false;
  const double f_a = turn(e.a, e.b, f.a), f_b = turn(e.a, e.b, f.b);
  if (((e_a > 0) != (e_b > 0)) && ((f_a > 0) != (f_b > 0)) && e_a != 0 && e_b != 0 && f_a != 0 && f_b != 0)
    return true;
  return distance_to_segment(e.a, f.a, f.b) < kContact || distance_to_segment(e.b, f.a, f.b) < kContact ||
         distance_to_segment(f.a, e.a, e.b) < kContact || distance_to_segment(f.b, e.a, e.b) < kContact;
}

// True when the corners of two edges lie on both sides by more than contact: they cross, not only touch.
bool cross(const Edge& e, const Edge& f) {
  const double e_length = glm::length(e.b - e.a), f_length = glm::length(f.b - f.a);
  const double e_a = turn(f.a, f.b, e.a) / f_length, e_b = turn(f.a, f.b, e.b) / f_length;
  const double f_a = turn(e.a, e.b, f.a) / e_length, f_b = turn(e.a, e.b, f.b) / e_length;
  return std::min(e_a, e_b) < -kContact && std::max(e_a, e_b) > kContact && std::min(f_a, f_b) < -kContact &&
         std::max(f_a, f_b) > kContact;
}

RingCheck compare(const Edge& e, const Edge& f, const FlatPolygon& polygon) {
  if (e.ring == f.ring) {
    const uint32_t first = polygon.ring_first[e.ring], count = polygon.ring_first[e.ring + 1] - first;
    const bool f_follows = (e.corner - first + 1) % count == f.corner - first;
    const bool e_follows = (f.corner - first + 1) % count == e.corner - first;
    if (f_follows || e_follows) {
      // A triangle's edges follow each other both ways; its area is checked already.
      const bool fault = count > 3 && (f_follows ? folds_back(e, f) : folds_back(f, e));
      return fault ? RingCheck{RingFault::kSelfIntersecting, e.ring, f_follows ? f.corner : e.corner}
                   : RingCheck{};
    }
    return touch(e, f) ? RingCheck{RingFault::kSelfIntersecting, e.ring, std::max(e.corner, f.corner)}
                       : RingCheck{};
  }
  if (!touch(e, f)) return {};
  const Edge& later = e.ring > f.ring ? e : f;
  if (std::min(e.ring, f.ring) > 0) return {RingFault::kHolesOverlap, later.ring, later.corner};
  return {cross(e, f) ? RingFault::kHoleOutside : RingFault::kHoleTouches, later.ring, later.corner};
}

RingCheck check_edges(const FlatPolygon& polygon) {
  std::vector<Edge> edges;
  edges.reserve(polygon.flat.size());
  for (uint32_t ring = 0; ring < polygon.ring_count(); ++ring) {
    const uint32_t first = polygon.ring_first[ring], last = polygon.ring_first[ring + 1];
    for (uint32_t k = first; k < last; ++k) {
      const DVec2 a = polygon.flat[k], b = polygon.flat[k + 1 < last ? k + 1 : first];
      edges.push_back({a, b, glm::min(a, b) - kContact, glm::max(a, b) + kContact, ring, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low.x != b.low.x ? a.low.x < b.low.x : a.corner < b.corner;
  });
  RingCheck worst;
  for (size_t i = 0; i < edges.size(); ++i)
    for (size_t j = i + 1; j < edges.size() && edges[j].low.x <= edges[i].high.x; ++j) {
      if (edges[j].low.y > edges[i].high.y || edges[j].high.y < edges[i].low.y) continue;
      const RingCheck found = compare(edges[i], edges[j], polygon);
      // A hole that crosses also touches somewhere: crossing says more.
      if (found.fault == RingFault::kHoleTouches && worst.fault == RingFault::kNoFault) worst = found;
      if (found.fault != RingFault::kNoFault && found.fault != RingFault::kHoleTouches) return found;
    }
  return worst;
}

}  // namespace

bool is_inside_ring(const FlatPolygon& polygon, size_t ring, DVec2 point) {
  bool inside = false;
  const uint32_t first = polygon.ring_first[ring], last = polygon.ring_first[ring + 1];
  for (uint32_t k = first, before = last - 1; k < last; before = k++) {
    const DVec2 a = polygon.flat[before], b = polygon.flat[k];
    if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x)
      inside = !inside;
  }
  return inside;
}

RingCheck check_rings(const FlatPolygon& polygon) {
  RingCheck found = check_edges(polygon);
  if (found.fault != RingFault::kNoFault) return found;
  const size_t rings = polygon.ring_count();
  std::vector<DVec2> low(rings), high(rings);
  for (size_t ring = 0; ring < rings; ++ring) {
    low[ring] = high[ring] = polygon.flat[polygon.ring_first[ring]];
    for (uint32_t k = polygon.ring_first[ring]; k < polygon.ring_first[ring + 1]; ++k) {
      low[ring] = glm::min(low[ring], polygon.flat[k]);
      high[ring] = glm::max(high[ring], polygon.flat[k]);
    }
  }
  for (uint32_t ring = 1; ring < rings; ++ring) {
    const uint32_t corner = polygon.ring_first[ring];
    if (!is_inside_ring(polygon, 0, polygon.flat[corner])) return {RingFault::kHoleOutside, ring, corner};
    for (uint32_t other = 1; other < rings; ++other) {
      const bool within = other != ring && low[other].x <= low[ring].x && low[other].y <= low[ring].y &&
                          high[other].x >= high[ring].x && high[other].y >= high[ring].y;
      if (within && is_inside_ring(polygon, other, polygon.flat[corner]))
        return {RingFault::kHolesOverlap, std::max(ring, other), corner};
    }
  }
  return {};
}

}  // namespace patchlight
