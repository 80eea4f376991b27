// Triangles to better ones: Delaunay flips (Lawson: Software for C1 Surface Interpolation, 1977), then pairs
// to quads.
#include "dsl/polygons/triangulate.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kFlipMin = 1e-12;  // a flip must gain more than rounding
constexpr size_t kFlipsPerTriangle = 64;
constexpr double kCosineMax = 0.70711;  // of 45 and 135 degrees

// Half edge k of triangle t is 3 t + k; it runs from corner k to corner k + 1. The other half, or kNone.
std::vector<uint32_t> find_twins(const std::vector<FaceCorners>& triangles) {
  struct Row {
    uint64_t key;
    uint32_t half;
  };
  std::vector<Row> rows;
  rows.reserve(triangles.size() * 3);
  for (uint32_t t = 0; t < triangles.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint64_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      rows.push_back({std::min(a, b) << 32 | std::max(a, b), 3 * t + k});
    }
  std::sort(rows.begin(), rows.end(),
            [](const Row& a, const Row& b) { return a.key != b.key ? a.key < b.key : a.half < b.half; });
  std::vector<uint32_t> twin(triangles.size() * 3, kNone);
  for (size_t k = 0; k + 1 < rows.size(); ++k)
    if (rows[k].key == rows[k + 1].key) {
      twin[rows[k].half] = rows[k + 1].half;
      twin[rows[k + 1].half] = rows[k].half;
    }
  return twin;
}

uint32_t next_half(uint32_t half) { return half % 3 == 2 ? half - 2 : half + 1; }

// Above 0 when d lies in the circle through a, b, c (counter-clockwise).
double in_circle(DVec2 a, DVec2 b, DVec2 c, DVec2 d) {
  a -= d;
  b -= d;
  c -= d;
  return glm::dot(a, a) * (b.x * c.y - b.y * c.x) - glm::dot(b, b) * (a.x * c.y - a.y * c.x) +
         glm::dot(c, c) * (a.x * b.y - a.y * b.x);
}

void set_corners(FaceCorners& face, uint32_t a, uint32_t b, uint32_t c) { face = {a, b, c, c}; }

struct Pair {
  double badness;
  uint32_t half, other;
  std::array<uint32_t, 4> corners;
};

// How far a quad is from a square: the worst corner's cosine plus the excess of its Jacobian ratio. Above
// 1e30: not allowed.
double badness_of(std::span<const DVec2> points, const std::array<uint32_t, 4>& corners) {
  std::array<DVec2, 4> quad;
  for (size_t k = 0; k < 4; ++k) quad[k] = points[corners[k]];
  const double ratio = jacobian_ratio(quad);
  if (ratio > kJacobianRatioMax) return 1e300;
  double cosine = 0, shortest = 1e300, longest = 0;
  for (size_t k = 0; k < 4; ++k) {
    const DVec2 out = quad[(k + 1) % 4] - quad[k], back = quad[(k + 3) % 4] - quad[k];
    cosine = std::max(cosine, std::abs(glm::dot(out, back)) / (glm::length(out) * glm::length(back)));
    shortest = std::min(shortest, glm::length(out));
    longest = std::max(longest, glm::length(out));
  }
  if (cosine > kCosineMax) return 1e300;
  return cosine + 0.2 * (ratio - 1) + 0.05 * (longest / shortest - 1);
}

}  // namespace

double jacobian_ratio(const std::array<DVec2, 4>& quad) {
  double least = 1e300, most = 0;
  for (size_t k = 0; k < 4; ++k) {
    const double corner = turn(quad[(k + 3) % 4], quad[k], quad[(k + 1) % 4]);
    least = std::min(least, corner);
    most = std::max(most, corner);
  }
  return least > 1e-9 * most ? most / least : 1e300;
}

void flip_to_delaunay(std::span<const DVec2> points, std::vector<FaceCorners>& triangles) {
  std::vector<uint32_t> twin = find_twins(triangles);
  std::vector<uint32_t> stack;
  std::vector<uint8_t> waiting(twin.size(), 0);
  for (uint32_t half = 0; half < twin.size(); ++half)
    if (twin[half] != kNone && half < twin[half]) stack.push_back(half), waiting[half] = 1;
  size_t budget = kFlipsPerTriangle * triangles.size();
  while (!stack.empty() && budget > 0) {
    const uint32_t half = stack.back();
    stack.pop_back();
    waiting[half] = 0;
    const uint32_t other = twin[half];
    if (other == kNone) continue;
    const uint32_t t = half / 3, s = other / 3;
    // The pair: a -> b is the shared edge of t, c lies across in t, d in s.
    const uint32_t a = triangles[t][half % 3], b = triangles[t][next_half(half) % 3],
                   c = triangles[t][next_half(next_half(half)) % 3],
                   d = triangles[s][next_half(next_half(other)) % 3];
    const DVec2 pa = points[a], pb = points[b], pc = points[c], pd = points[d];
    if (turn(pc, pa, pd) <= kFlipMin || turn(pd, pb, pc) <= kFlipMin) continue;
    const double reach = std::max({glm::length(pa - pd), glm::length(pb - pd), glm::length(pc - pd)});
    if (in_circle(pa, pb, pc, pd) <= kFlipMin * reach * reach * reach * reach) continue;
    --budget;
    const uint32_t bc = twin[next_half(half)], ca = twin[next_half(next_half(half))];
    const uint32_t ad = twin[next_half(other)], db = twin[next_half(next_half(other))];
    set_corners(triangles[t], c, a, d);
    set_corners(triangles[s], d, b, c);
    const auto tie = [&](uint32_t inner, uint32_t outer) {
      twin[inner] = outer;
      if (outer != kNone) twin[outer] = inner;
    };
    tie(3 * t, ca);
    tie(3 * t + 1, ad);
    tie(3 * s, db);
    tie(3 * s + 1, bc);
    tie(3 * t + 2, 3 * s + 2);
    for (const uint32_t edge : {3 * t, 3 * t + 1, 3 * s, 3 * s + 1})
      if (twin[edge] != kNone && !waiting[edge]) stack.push_back(edge), waiting[edge] = 1;
  }
}

void merge_to_quads(std::span<const DVec2> points, std::vector<FaceCorners>& faces) {
  const std::vector<uint32_t> twin = find_twins(faces);
  std::vector<Pair> pairs;
  for (uint32_t half = 0; half < twin.size(); ++half) {
    const uint32_t other = twin[half];
    if (other == kNone || other < half) continue;
    const FaceCorners& t = faces[half / 3];
    const FaceCorners& s = faces[other / 3];
    const std::array<uint32_t, 4> corners = {t[half % 3], s[next_half(next_half(other)) % 3],
                                             t[next_half(half) % 3], t[next_half(next_half(half)) % 3]};
    const double badness = badness_of(points, corners);
    if (badness < 1e30) pairs.push_back({badness, half, other, corners});
  }
  // Badness in coarse steps: rounding must not decide between equal pairs.
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    const double step_a = std::round(a.badness * 1e6), step_b = std::round(b.badness * 1e6);
    return step_a != step_b ? step_a < step_b : a.half < b.half;
  });
  std::vector<uint8_t> taken(faces.size(), 0);
  std::vector<FaceCorners> merged;
  for (const Pair& pair : pairs) {
    if (taken[pair.half / 3] || taken[pair.other / 3]) continue;
    taken[pair.half / 3] = taken[pair.other / 3] = 1;
    merged.push_back(pair.corners);
  }
  for (size_t k = 0; k < faces.size(); ++k)
    if (!taken[k]) merged.push_back(faces[k]);
  faces = std::move(merged);
}

}  // namespace patchlight
