// Walls whose corners run the wrong way, found by the edges that they share.
#include "dsl/scene/suspicious.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

constexpr double kSurrounded = 0.6;            // share of a lamp's sky that backs fill: more is a mistake
constexpr size_t kShellPolygonsMin = 4;        // fewer polygons make no room
constexpr size_t kSolidAnglesMax = 4'000'000;  // of triangles seen from lamps

// One edge of a ring: its two corners as numbers of equal points, the lower one first.
struct Edge {
  uint32_t low, high, polygon;
  bool forward;  // it runs from low to high
};

// Two polygons along one edge. They agree when they run along it in opposite directions.
struct Link {
  uint32_t polygon, other;
  bool agrees;
};

// Polygons that hang together by edges, and which of two ways round each of them is.
struct Shells {
  std::vector<uint32_t> shell;  // a row a polygon, kNone: not searched
  std::vector<uint8_t> side;    // 0 or 1
  std::vector<uint8_t> bad;     // a row a shell: it has no two sides
  size_t size() const { return bad.size(); }
};

// Twice the area of a ring as a vector along its normal.
DVec3 area_of(std::span<const DVec3> ring) {
  DVec3 sum(0);
  for (size_t k = 1; k + 1 < ring.size(); ++k) sum += glm::cross(ring[k] - ring[0], ring[k + 1] - ring[0]);
  return sum;
}

// Area of a polygon, as a vector: its holes, of either winding, taken off.
DVec3 net_area_of(const OutlineTable& outlines, uint32_t p) {
  const uint32_t first = outlines.polygon_first[p], last = outlines.polygon_first[p + 1];
  const DVec3 outline = area_of(ring_of(outlines, first));
  DVec3 sum = outline;
  for (uint32_t ring = first + 1; ring < last; ++ring) {
    const DVec3 hole = area_of(ring_of(outlines, ring));
    sum -= glm::dot(hole, outline) > 0 ? hole : -hole;
  }
  return sum / 2.0;
}

bool is_searched(const ObjectTable& objects, const OutlineTable& outlines, uint32_t p) {
  const uint32_t object = outlines.object[p];
  return !objects.is_mesh[object] && !objects.two_sided[object];
}

// Numbers of the corners: equal ones have one.
std::vector<uint32_t> number_points(const OutlineTable& outlines) {
  std::vector<uint32_t> order(outlines.corners.size()), number(order.size());
  for (uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto before = [&](uint32_t a, uint32_t b) {
    const DVec3 &p = outlines.corners[a], &q = outlines.corners[b];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  };
  std::sort(order.begin(), order.end(), before);
  uint32_t next = 0;
  for (size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && before(order[k - 1], order[k])) ++next;
    number[order[k]] = next;
  }
  return number;
}

std::vector<Edge> list_edges(const ObjectTable& objects, const OutlineTable& outlines) {
  const std::vector<uint32_t> number = number_points(outlines);
  std::vector<Edge> edges;
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    if (!is_searched(objects, outlines, p)) continue;
    const uint32_t first_ring = outlines.polygon_first[p];
    const DVec3 outline = area_of(ring_of(outlines, first_ring));
    for (uint32_t ring = first_ring; ring < outlines.polygon_first[p + 1]; ++ring) {
      const bool reversed = ring > first_ring && glm::dot(area_of(ring_of(outlines, ring)), outline) > 0;
      const uint32_t begin = outlines.ring_first[ring], end = outlines.ring_first[ring + 1];
      for (uint32_t k = begin; k < end; ++k) {
        const uint32_t a = number[k], b = number[k + 1 < end ? k + 1 : begin];
        if (a != b) edges.push_back({std::min(a, b), std::max(a, b), p, (a < b) != reversed});
      }
    }
  }
  return edges;
}

// The edges that two polygons share, no more and no fewer.
std::vector<Link> list_links(std::vector<Edge> edges) {
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.polygon < b.polygon;
  });
  std::vector<Link> links;
  for (size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].low == edges[first].low &&
           edges[last].high == edges[first].high)
      ++last;
    const Edge &a = edges[first], &b = edges[last - 1];
    if (last - first == 2 && a.polygon != b.polygon) {
      links.push_back({a.polygon, b.polygon, a.forward != b.forward});
      links.push_back({b.polygon, a.polygon, a.forward != b.forward});
    }
  }
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& a, const Link& b) { return a.polygon < b.polygon; });
  return links;
}

Shells find_shells(const std::vector<Link>& links, const std::vector<uint32_t>& link_first) {
  const size_t polygons = link_first.size() - 1;
  Shells shells;
  shells.shell.assign(polygons, kNone);
  shells.side.assign(polygons, 0);
  std::vector<uint32_t> open;
  for (uint32_t start = 0; start < polygons; ++start) {
    if (shells.shell[start] != kNone || link_first[start] == link_first[start + 1]) continue;
    const auto shell = static_cast<uint32_t>(shells.size());
    shells.bad.push_back(0);
    shells.shell[start] = shell;
    open.assign(1, start);
    while (!open.empty()) {
      const uint32_t p = open.back();
      open.pop_back();
      for (uint32_t k = link_first[p]; k < link_first[p + 1]; ++k) {
        const uint32_t other = links[k].other;
        const auto side = static_cast<uint8_t>(links[k].agrees ? shells.side[p] : 1 - shells.side[p]);
        if (shells.shell[other] == kNone) {
          shells.shell[other] = shell;
          shells.side[other] = side;
          open.push_back(other);
        } else if (shells.side[other] != side) {
          shells.bad[shell] = 1;
        }
      }
    }
  }
  return shells;
}

// Of each shell the side that less area is on; 2 where all polygons are on one side.
std::vector<uint8_t> find_minorities(const OutlineTable& outlines, const Shells& shells) {
  std::vector<std::array<double, 2>> area(shells.size(), {0, 0});
  for (uint32_t p = 0; p < outlines.size(); ++p)
    if (shells.shell[p] != kNone)
      area[shells.shell[p]][shells.side[p]] += glm::length(net_area_of(outlines, p));
  std::vector<uint8_t> minority;
  for (const auto& [first, second] : area)
    minority.push_back(first == 0 || second == 0 ? 2 : static_cast<uint8_t>(second <= first));
  return minority;
}

Place polygon_place(const Tree& tree, const OutlineTable& outlines, uint32_t p) {
  return place_of(tree, outlines.ring_node[outlines.polygon_first[p]]);
}

// Solid angle of a triangle from the origin, above 0 when its back is seen (Van Oosterom, Strackee: The Solid
// Angle of a Plane Triangle, 1983).
double solid_angle(DVec3 a, DVec3 b, DVec3 c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double above = glm::dot(a, glm::cross(b, c));
  const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2 * std::atan2(above, below);
}

double solid_angle(const OutlineTable& outlines, uint32_t p, DVec3 from) {
  double sum = 0;
  const uint32_t first = outlines.polygon_first[p];
  const DVec3 outline = area_of(ring_of(outlines, first));
  for (uint32_t ring = first; ring < outlines.polygon_first[p + 1]; ++ring) {
    const auto corners = ring_of(outlines, ring);
    double angle = 0;
    for (size_t k = 1; k + 1 < corners.size(); ++k)
      angle += solid_angle(corners[0] - from, corners[k] - from, corners[k + 1] - from);
    const bool reversed = ring > first && glm::dot(area_of(corners), outline) > 0;
    sum += reversed ? -angle : angle;
  }
  return sum;
}

std::vector<uint32_t> list_lamps(const MaterialTable& materials, const OutlineTable& outlines) {
  std::vector<uint32_t> lamps;
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const DRgb e = outlines.material[p] == kNone ? DRgb(0) : materials.emission[outlines.material[p]];
    if (std::max({e.r, e.g, e.b}) > 0) lamps.push_back(p);
  }
  return lamps;
}

DVec3 middle_of(const OutlineTable& outlines, uint32_t p) {
  DVec3 middle(0);
  const auto corners = ring_of(outlines, outlines.polygon_first[p]);
  for (const DVec3& corner : corners) middle += corner / static_cast<double>(corners.size());
  return middle;
}

// Lamps among the backs of a shell whose polygons agree. One warning a shell.
void warn_of_inside_out(Messages& messages, const Tree& tree, const MaterialTable& materials,
                        const OutlineTable& outlines, const Shells& shells,
                        const std::vector<uint8_t>& minority) {
  std::vector<std::vector<uint32_t>> members(shells.size());
  for (uint32_t p = 0; p < outlines.size(); ++p)
    if (shells.shell[p] != kNone) members[shells.shell[p]].push_back(p);
  const std::vector<uint32_t> lamps = list_lamps(materials, outlines);
  size_t angles = 0;
  for (uint32_t shell = 0; shell < shells.size(); ++shell) {
    if (shells.bad[shell] || minority[shell] != 2 || members[shell].size() < kShellPolygonsMin) continue;
    for (const uint32_t lamp : lamps) {
      if (shells.shell[lamp] == shell) continue;
      if ((angles += members[shell].size()) > kSolidAnglesMax) return;
      const DVec3 middle = middle_of(outlines, lamp);
      double angle = 0;
      for (const uint32_t p : members[shell]) angle += solid_angle(outlines, p, middle);
      if (angle < kSurrounded * 4 * std::numbers::pi) continue;
      add_warning(messages, polygon_place(tree, outlines, lamp), "flipped",
                  fmt::format("'{}' shines on the backs of '{}' and {} more polygons around it, which stay "
                              "dark: turn the order of their corners round if this is a room",
                              escape_text(outlines.id[lamp]), escape_text(outlines.id[members[shell][0]]),
                              members[shell].size() - 1));
      break;
    }
  }
}

}  // namespace

void warn_of_flipped(Messages& messages, const Tree& tree, const MaterialTable& materials,
                     const ObjectTable& objects, const OutlineTable& outlines) {
  if (outlines.size() > kPolygonsSearched) return;
  const std::vector<Link> links = list_links(list_edges(objects, outlines));
  std::vector<uint32_t> link_first(outlines.size() + 1, 0);
  for (const Link& link : links) ++link_first[link.polygon + 1];
  for (size_t p = 0; p < outlines.size(); ++p) link_first[p + 1] += link_first[p];
  const Shells shells = find_shells(links, link_first);
  const std::vector<uint8_t> minority = find_minorities(outlines, shells);
  uint32_t reported = kNone;  // one message an object
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const uint32_t shell = shells.shell[p];
    if (shell == kNone || shells.bad[shell] || shells.side[p] != minority[shell]) continue;
    uint32_t first = kNone, second = kNone;  // neighbours that run the other way
    for (uint32_t k = link_first[p]; k < link_first[p + 1]; ++k) {
      if (links[k].agrees) continue;
      if (first == kNone)
        first = links[k].other;
      else if (links[k].other != first)
        second = links[k].other;
    }
    if (second == kNone || outlines.object[p] == reported) continue;
    reported = outlines.object[p];
    add_warning(messages, polygon_place(tree, outlines, p), "flipped",
                fmt::format("'{}' faces the other way than '{}' and '{}' beside it; turn the order of its "
                            "corners round, or make it two_sided",
                            escape_text(outlines.id[p]), escape_text(outlines.id[first]),
                            escape_text(outlines.id[second])));
  }
  warn_of_inside_out(messages, tree, materials, outlines, shells, minority);
}

namespace {

// Six times the volume that polygons enclose, seen from `base`; below 0 where their backs are outside.
double volume_of(const OutlineTable& outlines, uint32_t first, uint32_t last, DVec3 base) {
  double sum = 0;
  for (uint32_t p = first; p < last; ++p) {
    const auto corners = ring_of(outlines, outlines.polygon_first[p]);
    for (size_t k = 1; k + 1 < corners.size(); ++k)
      sum += glm::dot(corners[0] - base, glm::cross(corners[k] - base, corners[k + 1] - base));
  }
  return sum;
}

// Is every edge run as often one way as the other?
bool is_closed(const OutlineTable& outlines, const std::vector<uint32_t>& number, uint32_t first,
               uint32_t last) {
  std::vector<std::array<uint32_t, 3>> edges;  // the lower corner, the higher one, 1: from the higher one
  for (uint32_t p = first; p < last; ++p) {
    const uint32_t ring = outlines.polygon_first[p];
    const uint32_t begin = outlines.ring_first[ring], end = outlines.ring_first[ring + 1];
    for (uint32_t k = begin; k < end; ++k) {
      const uint32_t a = number[k], b = number[k + 1 < end ? k + 1 : begin];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a > b ? 1u : 0u});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (size_t k = 0, next = 0; k < edges.size(); k = next) {
    size_t down = 0;
    while (next < edges.size() && edges[next][0] == edges[k][0] && edges[next][1] == edges[k][1])
      down += edges[next++][2];
    if (2 * down != next - k) return false;
  }
  return !edges.empty();
}

}  // namespace

void warn_of_inside_out_meshes(Messages& messages, const Tree& tree, const MaterialTable& materials,
                               const ObjectTable& objects, const OutlineTable& outlines,
                               std::span<const Camera> cameras) {
  std::vector<uint32_t> number;
  std::vector<DVec3> points;  // of lamps and cameras
  for (const Camera& camera : cameras) points.push_back(camera.eye);
  std::vector<uint32_t> lamps = list_lamps(materials, outlines);
  for (const uint32_t lamp : lamps) points.push_back(middle_of(outlines, lamp));
  size_t angles = 0;
  for (uint32_t first = 0, last = 0; first < outlines.size(); first = last) {
    const uint32_t object = outlines.object[first];
    while (last < outlines.size() && outlines.object[last] == object) ++last;
    if (!objects.is_mesh[object] || objects.two_sided[object]) continue;
    const DVec3 base = outlines.corners[outlines.ring_first[outlines.polygon_first[first]]];
    if (!(volume_of(outlines, first, last, base) < 0)) continue;
    if (number.empty()) number = number_points(outlines);
    if (!is_closed(outlines, number, first, last)) continue;
    bool is_room = false;
    for (const DVec3& point : points) {
      if ((angles += last - first) > kSolidAnglesMax) return;
      double angle = 0;
      for (uint32_t p = first; p < last; ++p) angle += solid_angle(outlines, p, point);
      is_room = is_room || std::abs(angle) > kSurrounded * 4 * std::numbers::pi;
    }
    if (is_room) continue;
    add_warning(
        messages, place_of(tree, objects.node[object]), "inside-out",
        "this mesh is closed and all its faces look inward: from outside its backs are seen, which stay "
        "dark; turn the order of the corners round in the file, or make it two_sided");
  }
}

}  // namespace patchlight
