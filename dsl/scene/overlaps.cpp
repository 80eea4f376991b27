// Polygons in one plane that overlap and face the same way.
#include "dsl/scene/suspicious.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kSmaller = 1 - 1e-5;
constexpr double kOneAngle = 1e-6;        // of normals: 1 - cosine
constexpr double kOnePlane = 2e-6;        // lengths: about a ray's offset
constexpr double kOverlapMin = 1e-5;      // share of the smaller polygon's area
constexpr size_t kPairsMax = 5'000'000;   // of polygons that are compared
constexpr size_t kWorkMax = 200'000'000;  // pairs of their faces and corners: what is beyond is not searched

// The polygons of a scene, two-sided ones with two rows, as far as they are searched.
struct PlaneTable {
  std::vector<uint32_t> polygon;  // row of scene.polygons
  std::vector<uint32_t> outline;  // row of OutlineTable
  std::vector<DVec3> normal, low, high;
  std::vector<double> offset;  // along the normal, which is turned so that it points up for this
  std::vector<double> area;
  size_t size() const { return polygon.size(); }
};

double face_area(const FaceTable& faces, uint32_t f) {
  const auto& c = faces.corners[f];
  return glm::length(glm::cross(DVec3(c[2]) - DVec3(c[0]), DVec3(c[3]) - DVec3(c[1]))) / 2;
}

PlaneTable list_planes(const ObjectTable& objects, const OutlineTable& outlines, const Scene& scene) {
  PlaneTable planes;
  const FaceTable& faces = scene.faces;
  uint32_t polygon = 0;
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const uint32_t object = outlines.object[p];
    for (int side = 0; side < (objects.two_sided[object] ? 2 : 1); ++side, ++polygon) {
      const uint32_t first = scene.polygons.face_first[polygon],
                     last = scene.polygons.face_first[polygon + 1];
      if (objects.is_mesh[object] || first == last) continue;
      DVec3 low(1e300), high(-1e300);
      double area = 0;
      for (uint32_t f = first; f < last; ++f) {
        area += face_area(faces, f);
        for (const Vec3& corner : faces.corners[f]) {
          low = glm::min(low, DVec3(corner));
          high = glm::max(high, DVec3(corner));
        }
      }
      const DVec3 normal(faces.normal[first]);
      const double offset = glm::dot(normal, DVec3(faces.corners[first][0]));
      const bool down = normal.x < -0.5 || (std::abs(normal.x) <= 0.5 &&
                                            (normal.y < -0.5 || (std::abs(normal.y) <= 0.5 && normal.z < 0)));
      planes.polygon.push_back(polygon);
      planes.outline.push_back(p);
      planes.normal.push_back(normal);
      planes.low.push_back(low);
      planes.high.push_back(high);
      planes.offset.push_back(down ? -offset : offset);
      planes.area.push_back(area);
    }
  }
  return planes;
}

// Cuts a convex polygon in the plane by the half plane left of a to b.
void clip(std::vector<DVec2>& points, DVec2 a, DVec2 b) {
  std::vector<DVec2> kept;
  const auto side = [&](DVec2 p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); };
  for (size_t k = 0; k < points.size(); ++k) {
    const DVec2 p = points[k], q = points[(k + 1) % points.size()];
    const double sp = side(p), sq = side(q);
    if (sp >= 0) kept.push_back(p);
    if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) kept.push_back(p + (q - p) * (sp / (sp - sq)));
  }
  points.swap(kept);
}

double area_of(const std::vector<DVec2>& points) {
  double twice = 0;
  for (size_t k = 1; k + 1 < points.size(); ++k) {
    const DVec2 u = points[k] - points[0], v = points[k + 1] - points[0];
    twice += u.x * v.y - u.y * v.x;
  }
  return twice / 2;
}

// A face on its plane, and the box around it.
struct FlatFace {
  std::array<DVec2, 4> corner;
  size_t count;
  DVec2 low, high;
};

std::vector<FlatFace> flatten_faces(const FaceTable& faces, uint32_t first, uint32_t last, DVec3 normal) {
  const DVec3 along =
      glm::normalize(glm::cross(std::abs(normal.x) < 0.5 ? DVec3(1, 0, 0) : DVec3(0, 1, 0), normal));
  const DVec3 across = glm::cross(normal, along);
  std::vector<FlatFace> flat;
  flat.reserve(last - first);
  for (uint32_t f = first; f < last; ++f) {
    FlatFace face{{}, faces.corner_count[f], DVec2(1e300), DVec2(-1e300)};
    for (size_t k = 0; k < face.count; ++k) {
      const DVec3 corner(faces.corners[f][k]);
      face.corner[k] = DVec2(glm::dot(corner, along), glm::dot(corner, across));
      face.low = glm::min(face.low, face.corner[k]);
      face.high = glm::max(face.high, face.corner[k]);
    }
    flat.push_back(face);
  }
  return flat;
}

// Do the faces of two polygons in one plane have more than that area in common (lengths squared)?
bool share_area(const FaceTable& faces, const PolygonTable& polygons, uint32_t a, uint32_t b, DVec3 normal,
                double least) {
  const auto flat = [&](uint32_t p) {
    return flatten_faces(faces, polygons.face_first[p], polygons.face_first[p + 1], normal);
  };
  const std::vector<FlatFace> cutters = flat(a), others = flat(b);
  std::vector<DVec2> points;
  double sum = 0;
  for (const FlatFace& cutter : cutters)
    for (const FlatFace& other : others) {
      if (other.low.x > cutter.high.x || other.high.x < cutter.low.x || other.low.y > cutter.high.y ||
          other.high.y < cutter.low.y)
        continue;
      points.assign(other.corner.begin(), other.corner.begin() + static_cast<ptrdiff_t>(other.count));
      for (size_t k = 0; k < cutter.count && !points.empty(); ++k)
        clip(points, cutter.corner[k], cutter.corner[(k + 1) % cutter.count]);
      sum += std::max(0.0, area_of(points));
      if (sum > least) return true;
    }
  return false;
}

// The same corners, in any order.
bool same_corners(const OutlineTable& outlines, uint32_t p, uint32_t q) {
  const auto a = ring_of(outlines, outlines.polygon_first[p]),
             b = ring_of(outlines, outlines.polygon_first[q]);
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const DVec3& corner) {
           return std::find(b.begin(), b.end(), corner) != b.end();
         });
}

// Do two polygons lie in one plane, face the same way and overlap? `work` counts the pairs of faces and
// corners that this took; false where it would take more than kWorkMax.
bool is_overlap(const PlaneTable& planes, const OutlineTable& outlines, const Scene& scene, size_t i,
                size_t j, size_t& work) {
  if (glm::dot(planes.normal[i], planes.normal[j]) < 1 - kOneAngle) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (planes.low[i][axis] > planes.high[j][axis] + kOnePlane ||
        planes.low[j][axis] > planes.high[i][axis] + kOnePlane)
      return false;
  const size_t small = planes.area[i] < planes.area[j] ? i : j, large = small == i ? j : i;
  const FaceTable& faces = scene.faces;
  const PolygonTable& polygons = scene.polygons;
  const DVec3 origin(faces.corners[polygons.face_first[planes.polygon[large]]][0]);
  for (uint32_t f = polygons.face_first[planes.polygon[small]];
       f < polygons.face_first[planes.polygon[small] + 1]; ++f)
    for (const Vec3& corner : faces.corners[f])
      if (std::abs(glm::dot(DVec3(corner) - origin, planes.normal[large])) > kOnePlane) return false;
  const auto face_count = [&](size_t k) -> size_t {
    return polygons.face_first[planes.polygon[k] + 1] - polygons.face_first[planes.polygon[k]];
  };
  const auto corner_count = [&](size_t k) {
    return ring_of(outlines, outlines.polygon_first[planes.outline[k]]).size();
  };
  const size_t needed = face_count(i) * face_count(j) + corner_count(i) * corner_count(j);
  if (needed > kWorkMax - work) return false;
  work += needed;
  return !same_corners(outlines, planes.outline[i], planes.outline[j]) &&
         share_area(faces, polygons, planes.polygon[i], planes.polygon[j], planes.normal[large],
                    kOverlapMin * planes.area[small]);
}

}  // namespace

void warn_of_overlaps(Messages& messages, const Tree& tree, const ObjectTable& objects,
                      const OutlineTable& outlines, const Scene& scene) {
  if (outlines.size() > kPolygonsSearched) return;
  const PlaneTable planes = list_planes(objects, outlines, scene);
  std::vector<size_t> order(planes.size());
  for (size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return planes.offset[a] != planes.offset[b] ? planes.offset[a] < planes.offset[b] : a < b;
  });
  size_t pairs = 0, work = 0;
  for (size_t i = 0; i < order.size(); ++i)
    for (size_t j = i + 1;
         j < order.size() && planes.offset[order[j]] - planes.offset[order[i]] < 4 * kOnePlane; ++j) {
      if (++pairs > kPairsMax) return;
      if (!is_overlap(planes, outlines, scene, order[i], order[j], work)) continue;
      // The smaller one is the lamp or the rug; of equals, but for rounding, the later.
      const auto [first, second] = std::minmax(order[i], order[j]);
      const size_t small = planes.area[first] < planes.area[second] * kSmaller ? first : second,
                   large = small == first ? second : first;
      const uint32_t p = planes.outline[small];
      add_warning(
          messages, place_of(tree, outlines.ring_node[outlines.polygon_first[p]]), "coincident",
          fmt::format("'{}' lies in the plane of '{}' and overlaps it; light and shadow between the two "
                      "are left to rounding: move it a little off",
                      escape_text(scene.polygons.id[planes.polygon[small]]),
                      escape_text(scene.polygons.id[planes.polygon[large]])));
    }
}

}  // namespace patchlight
