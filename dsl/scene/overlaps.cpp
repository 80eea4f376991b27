// Polygons in one plane that overlap.
#include "dsl/scene/sheets.h"
#include "dsl/scene/suspicious.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kSmaller = 1 - 1e-5;
constexpr double kOneAngle = 1e-6;        // of normals: 1 - cosine
constexpr double kOnePlaneOwn = 1e-5;     // kOnePlane at most this share of the smaller one's size
constexpr double kOverlapMin = 1e-5;      // share of the smaller polygon's area
constexpr size_t kPairsMax = 5'000'000;   // of polygons that are compared
constexpr size_t kWorkMax = 200'000'000;  // pairs of their faces and corners: what is beyond is not searched

struct Box {
  DVec3 low{1e300}, high{-1e300};
  void add(DVec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
};

// The polygons of a scene as far as they are searched.
struct PlaneTable {
  std::vector<uint32_t> polygon;  // row of OutlineTable
  std::vector<DVec3> normal;
  std::vector<Box> box;
  std::vector<double> offset;  // along the normal, which is turned so that it points up for this
  std::vector<double> area;
  size_t size() const { return polygon.size(); }
};

DVec3 corner_of(const CutTable& table, uint32_t p, uint32_t face, size_t corner) {
  return table.points[table.point_first[p] + table.faces[face][corner]];
}

PlaneTable list_planes(const ObjectTable& objects, const OutlineTable& outlines, const CutTable& table) {
  PlaneTable planes;
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const uint32_t first = table.face_first[p], last = table.face_first[p + 1];
    if (objects.is_mesh[outlines.object[p]] || first == last) continue;
    Box box;
    double area = 0;
    for (uint32_t f = first; f < last; ++f) {
      const auto at = [&](size_t k) { return corner_of(table, p, f, k); };
      area += glm::length(glm::cross(at(2) - at(0), at(3) - at(1))) / 2;
      for (size_t k = 0; k < 4; ++k) box.add(at(k));
    }
    const DVec3 normal = table.normal[p];
    const double offset = glm::dot(normal, corner_of(table, p, first, 0));
    const bool down = normal.x < -0.5 || (std::abs(normal.x) <= 0.5 &&
                                          (normal.y < -0.5 || (std::abs(normal.y) <= 0.5 && normal.z < 0)));
    planes.polygon.push_back(p);
    planes.normal.push_back(normal);
    planes.box.push_back(box);
    planes.offset.push_back(down ? -offset : offset);
    planes.area.push_back(area);
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

std::vector<FlatFace> flatten_faces(const CutTable& table, uint32_t p, DVec3 normal, DVec3 origin) {
  const DVec3 along =
      glm::normalize(glm::cross(std::abs(normal.x) < 0.5 ? DVec3(1, 0, 0) : DVec3(0, 1, 0), normal));
  const DVec3 across = glm::cross(normal, along);
  std::vector<FlatFace> flat;
  for (uint32_t f = table.face_first[p]; f < table.face_first[p + 1]; ++f) {
    FlatFace face{{}, is_triangle(table.faces[f]) ? 3u : 4u, DVec2(1e300), DVec2(-1e300)};
    for (size_t k = 0; k < face.count; ++k) {
      const DVec3 corner = corner_of(table, p, f, k) - origin;
      face.corner[k] = DVec2(glm::dot(corner, along), glm::dot(corner, across));
      face.low = glm::min(face.low, face.corner[k]);
      face.high = glm::max(face.high, face.corner[k]);
    }
    // Counter-clockwise on this plane, whichever way the polygon faces.
    if (glm::dot(table.normal[p], normal) < 0)
      std::reverse(face.corner.begin(), face.corner.begin() + static_cast<ptrdiff_t>(face.count));
    flat.push_back(face);
  }
  return flat;
}

// Do the faces of two polygons in one plane have more than that area in common (file units squared)?
bool share_area(const CutTable& table, uint32_t a, uint32_t b, double least) {
  const DVec3 normal = table.normal[a], origin = corner_of(table, a, table.face_first[a], 0);
  const std::vector<FlatFace> cutters = flatten_faces(table, a, normal, origin),
                              others = flatten_faces(table, b, normal, origin);
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

struct Search {
  const ObjectTable& objects;
  const OutlineTable& outlines;
  const CutTable& table;
  const PlaneTable& planes;
  std::vector<Box> object_box;  // a row an object: all its polygons that are searched
  double near;                  // file units
  size_t work = 0;              // pairs of faces and corners that were compared
};

bool holds(const Box& outer, const Box& inner, double near) {
  for (int axis = 0; axis < 3; ++axis)
    if (inner.low[axis] < outer.low[axis] - near || inner.high[axis] > outer.high[axis] + near) return false;
  return true;
}

// Does a solid stand on the front of the other polygon, where nothing is to be lit? A room that is drawn
// inside of a box is no such case.
bool is_buried(const Search& search, uint32_t p, uint32_t q) {
  const uint32_t solid = search.outlines.object[p], other = search.outlines.object[q];
  if (!search.objects.is_solid[solid]) return false;
  return search.objects.is_solid[other] ||
         !holds(search.object_box[solid], search.object_box[other], search.near);
}

// False where two rows of the planes do not overlap, or to tell would take more than kWorkMax.
bool find_overlap(Search& search, size_t i, size_t j, Overlap& overlap) {
  const PlaneTable& planes = search.planes;
  const CutTable& table = search.table;
  const double cosine = glm::dot(planes.normal[i], planes.normal[j]);
  if (std::abs(cosine) < 1 - kOneAngle) return false;
  for (int axis = 0; axis < 3; ++axis)
    if (planes.box[i].low[axis] > planes.box[j].high[axis] + search.near ||
        planes.box[j].low[axis] > planes.box[i].high[axis] + search.near)
      return false;
  // The smaller one is the lamp or the rug; of equals, but for rounding, the later.
  const auto [first, second] = std::minmax(i, j);
  const size_t small = planes.area[first] < planes.area[second] * kSmaller ? first : second,
               large = small == first ? second : first;
  const uint32_t p = planes.polygon[small], q = planes.polygon[large];
  const DVec3 origin = corner_of(table, q, table.face_first[q], 0);
  // Small plates that nearly touch are two, also beside a wide ground.
  const double near = std::min(search.near, kOnePlaneOwn * std::sqrt(planes.area[small]));
  for (uint32_t f = table.face_first[p]; f < table.face_first[p + 1]; ++f)
    for (size_t k = 0; k < 4; ++k)
      if (std::abs(glm::dot(corner_of(table, p, f, k) - origin, planes.normal[large])) > near) return false;
  const bool any_two_sided = search.objects.two_sided[search.outlines.object[p]] ||
                             search.objects.two_sided[search.outlines.object[q]];
  const auto face_count = [&](uint32_t of) -> size_t {
    return table.face_first[of + 1] - table.face_first[of];
  };
  const auto corner_count = [&](uint32_t of) {
    return ring_of(search.outlines, search.outlines.polygon_first[of]).size();
  };
  const size_t needed = face_count(p) * face_count(q) + corner_count(p) * corner_count(q);
  if (needed > kWorkMax - search.work) return false;
  search.work += needed;
  overlap = {p, q, cosine > 0 || any_two_sided, same_corners(search.outlines, p, q)};
  if (!overlap.one_way && !overlap.same_corners && (is_buried(search, p, q) || is_buried(search, q, p)))
    return false;
  return overlap.same_corners || share_area(table, q, p, kOverlapMin * planes.area[small]);
}

}  // namespace

std::vector<Overlap> find_overlaps(const ObjectTable& objects, const OutlineTable& outlines,
                                   const CutTable& table, double length) {
  std::vector<Overlap> overlaps;
  if (outlines.size() > kPolygonsSearched) return overlaps;
  const PlaneTable planes = list_planes(objects, outlines, table);
  Search search{objects, outlines, table, planes, std::vector<Box>(objects.size()), kOnePlane * length};
  std::vector<size_t> order(planes.size());
  for (size_t k = 0; k < order.size(); ++k) {
    order[k] = k;
    Box& box = search.object_box[outlines.object[planes.polygon[k]]];
    box.add(planes.box[k].low), box.add(planes.box[k].high);
  }
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return planes.offset[a] != planes.offset[b] ? planes.offset[a] < planes.offset[b] : a < b;
  });
  size_t pairs = 0;
  for (size_t i = 0; i < order.size(); ++i)
    for (size_t j = i + 1;
         j < order.size() && planes.offset[order[j]] - planes.offset[order[i]] < 4 * search.near; ++j) {
      if (++pairs > kPairsMax) return overlaps;
      if (Overlap overlap; find_overlap(search, order[i], order[j], overlap)) overlaps.push_back(overlap);
    }
  return overlaps;
}

}  // namespace patchlight
