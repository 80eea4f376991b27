// Corners and edges of faces to which of them are the same.
#include "engine/mesh/face_links.h"

#include "engine/base/union_find.h"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <unordered_map>

namespace patchlight {
namespace {

struct CornerKey {
  uint32_t polygon;
  Vec3 point;
  bool operator==(const CornerKey& other) const {
    return polygon == other.polygon && std::memcmp(&point, &other.point, sizeof point) == 0;
  }
};
struct CornerHash {
  size_t operator()(const CornerKey& key) const {
    uint32_t bits[3];
    std::memcpy(bits, &key.point, sizeof bits);
    uint64_t hash = key.polygon;
    for (const uint32_t b : bits) hash = (hash ^ b) * 0x9e3779b97f4a7c15ull, hash ^= hash >> 29;
    return hash;
  }
};

}  // namespace

FaceLinkTable make_face_links(const FaceTable& faces) {
  FaceLinkTable links;
  links.edge.resize(faces.size());
  links.corner.resize(faces.size());
  std::unordered_map<CornerKey, uint32_t, CornerHash> first;
  first.reserve(faces.size() * 4);
  std::unordered_map<uint64_t, uint32_t> open_edges;  // (from corner, to corner) -> 4 * face + edge
  open_edges.reserve(faces.size() * 4);
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const uint32_t n = faces.corner_count[f];
    for (uint32_t k = 0; k < n; ++k) {
      Vec3 point = faces.corners[f][k] + 0.0f;  // no negative zeros: corners are compared as bits
      links.corner[f][k] = first.try_emplace({faces.polygon[f], point}, 4 * f + k).first->second;
    }
    for (uint32_t k = n; k < 4; ++k) links.corner[f][k] = links.corner[f][n - 1];
    for (uint32_t k = 0; k < n; ++k) {
      const uint64_t from = links.corner[f][k], to = links.corner[f][(k + 1) % n];
      if (const auto other = open_edges.find(to << 32 | from); other != open_edges.end()) {
        const uint32_t g = other->second / 4, e = other->second % 4;
        links.edge[f][k] = {g, static_cast<uint8_t>(e)};
        links.edge[g][e] = {f, static_cast<uint8_t>(k)};
        open_edges.erase(other);
      } else {
        open_edges.emplace(from << 32 | to, 4 * f + k);
      }
    }
  }
  return links;
}

FaceLinkTable make_smooth_links(const FaceLinkTable& links, const FaceTable& faces) {
  // A hair less than that of 30 degrees: all edges of a cylinder of twelve sides are alike, whatever rounding
  // makes of each.
  constexpr float kCreaseCosine = 0.866f;
  constexpr size_t kFanMax = 16;  // polygons on one edge; more are no surface
  struct Corner {
    uint32_t surface;
    Vec3 point;
    uint32_t at;  // 4 * face + corner
    auto key() const { return std::tuple(surface, point.x, point.y, point.z); }
  };
  std::vector<Corner> corners;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0; k < faces.corner_count[f] && faces.surface[f] != kNone; ++k)
      corners.push_back({faces.surface[f], faces.corners[f][k], 4 * f + k});
  FaceLinkTable smooth = links;
  if (corners.empty()) return smooth;
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return a.key() != b.key() ? a.key() < b.key() : a.at < b.at;
  });
  std::vector<uint32_t> point_of(4 * faces.size(), kNone);
  for (uint32_t k = 0, point = 0; k < corners.size(); ++k) {
    if (k > 0 && corners[k].key() != corners[k - 1].key()) ++point;
    point_of[corners[k].at] = point;
  }
  // An edge by its points in ascending order, and whether its face runs it upwards.
  struct Edge {
    uint32_t low, high, face;
    uint8_t edge;
    bool up;
  };
  std::vector<Edge> edges;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0, n = faces.corner_count[f]; k < n && faces.surface[f] != kNone; ++k) {
      const uint32_t from = point_of[4 * f + k], to = point_of[4 * f + (k + 1) % n];
      if (links.edge[f][k].face == kNone && from != to)
        edges.push_back({std::min(from, to), std::max(from, to), f, static_cast<uint8_t>(k), from < to});
    }
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.low, a.high) < std::pair(b.low, b.high);
  });
  // The name of a corner is the first of those that are the same.
  UnionFind same(4 * faces.size());
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0; k < faces.corner_count[f]; ++k) same.join(4 * f + k, links.corner[f][k]);
  for (size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].low == edges[first].low &&
           edges[last].high == edges[first].high)
      ++last;
    if (last - first > kFanMax) continue;
    const auto find_best = [&](size_t a) {
      size_t best = last;
      float best_cosine = kCreaseCosine;
      for (size_t b = first; b < last; ++b) {
        const uint32_t f = edges[a].face, g = edges[b].face;
        const float cosine = dot(faces.normal[f], faces.normal[g]);
        if (edges[a].up != edges[b].up && cosine > best_cosine &&
            faces.reflectance[f] == faces.reflectance[g] && faces.emission[f] == faces.emission[g])
          best = b, best_cosine = cosine;
      }
      return best;
    };
    for (size_t a = first; a < last; ++a) {
      const size_t b = find_best(a);
      if (b >= last || b < a || find_best(b) != a) continue;
      const Edge &one = edges[a], &other = edges[b];
      smooth.edge[one.face][one.edge] = {other.face, other.edge};
      smooth.edge[other.face][other.edge] = {one.face, one.edge};
      const uint32_t n = faces.corner_count[one.face], m = faces.corner_count[other.face];
      same.join(4 * one.face + one.edge, 4 * other.face + (other.edge + 1) % m);
      same.join(4 * one.face + (one.edge + 1) % n, 4 * other.face + other.edge);
    }
  }
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const uint32_t n = faces.corner_count[f];
    for (uint32_t k = 0; k < 4; ++k) smooth.corner[f][k] = same.find(4 * f + std::min(k, n - 1));
  }
  return smooth;
}

}  // namespace patchlight
