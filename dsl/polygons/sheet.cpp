// The outlines of all parts are cut at each other into a planar graph; its cells are joined again where the
// same parts lie on both sides, and what is left is cut into faces.
#include "dsl/polygons/sheet.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace patchlight {
namespace {

constexpr size_t kCornersMax = 4 * kSheetEdgesMax;  // crossings included
constexpr double kSmaller = 1 - 1e-5;               // of two areas: less than rounding makes of equals

// Corners on the plane of the first part, in units of its size, and where they are in space.
struct Plane {
  const FlatPolygon& base;
  double near;
  std::vector<DVec2> flat;
  std::vector<DVec3> point;

  DVec2 flat_of(DVec3 p) const {
    const DVec3 offset = (p - base.origin) / base.size;
    return {glm::dot(offset, base.axis_u), glm::dot(offset, base.axis_v)};
  }
  uint32_t add(DVec2 p, DVec3 in_space) {
    for (uint32_t k = 0; k < flat.size(); ++k)
      if (glm::length(flat[k] - p) <= near) return k;
    flat.push_back(p);
    point.push_back(in_space);
    return static_cast<uint32_t>(flat.size() - 1);
  }
};

struct Edge {
  uint32_t from, to, part;
};
using Segment = std::pair<uint32_t, uint32_t>;              // two corners, the lower first
using Outlines = std::map<Segment, std::vector<uint32_t>>;  // to the parts whose outline runs along it

std::vector<Edge> list_edges(std::span<const SheetPart> parts, Plane& plane) {
  std::vector<Edge> edges;
  for (uint32_t part = 0; part < parts.size(); ++part) {
    const FlatPolygon& flat = parts[part].flat;
    for (size_t ring = 0; ring < flat.ring_count(); ++ring) {
      const uint32_t first = flat.ring_first[ring], last = flat.ring_first[ring + 1];
      std::vector<uint32_t> corner;
      for (uint32_t k = first; k < last; ++k) {
        const DVec2 p = plane.flat_of(flat.points[k]);
        // Corners of the other parts may lie a hair off the plane: faces may not.
        corner.push_back(plane.add(p, part == 0 ? flat.points[k] : point_at(plane.base, p)));
      }
      for (size_t k = 0; k < corner.size(); ++k)
        if (const uint32_t to = corner[(k + 1) % corner.size()]; to != corner[k])
          edges.push_back({corner[k], to, part});
    }
  }
  return edges;
}

// How far along the segment a to b, 0..1, the point is nearest to it, and how near.
std::pair<double, double> place_on(DVec2 a, DVec2 b, DVec2 p) {
  const DVec2 along = b - a;
  const double t = glm::dot(p - a, along) / glm::dot(along, along);
  return {t, glm::length(a + along * std::clamp(t, 0.0, 1.0) - p)};
}

// False where there are too many.
bool add_crossings(const std::vector<Edge>& edges, Plane& plane) {
  for (size_t i = 0; i < edges.size(); ++i)
    for (size_t j = i + 1; j < edges.size(); ++j) {
      if (edges[i].part == edges[j].part) continue;
      const DVec2 a = plane.flat[edges[i].from], b = plane.flat[edges[i].to];
      const DVec2 c = plane.flat[edges[j].from], d = plane.flat[edges[j].to];
      if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
          std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
        continue;
      const double ac = turn(c, d, a), bc = turn(c, d, b), ca = turn(a, b, c), da = turn(a, b, d);
      if (!((ac > 0) != (bc > 0) && (ca > 0) != (da > 0))) continue;
      // An end that lies on the other edge is the crossing itself.
      if (place_on(c, d, a).second <= plane.near || place_on(c, d, b).second <= plane.near ||
          place_on(a, b, c).second <= plane.near || place_on(a, b, d).second <= plane.near)
        continue;
      const DVec2 p = a + (b - a) * (ac / (ac - bc));
      plane.add(p, point_at(plane.base, p));
      if (plane.flat.size() > kCornersMax) return false;
    }
  return true;
}

// Edges between neighbouring corners; each with the parts that it is a border of.
Outlines split_edges(const std::vector<Edge>& edges, const Plane& plane) {
  Outlines outlines;
  std::vector<std::pair<double, uint32_t>> on;
  for (const Edge& edge : edges) {
    const DVec2 a = plane.flat[edge.from], b = plane.flat[edge.to];
    on.assign(1, {0.0, edge.from});
    for (uint32_t k = 0; k < plane.flat.size(); ++k) {
      if (k == edge.from || k == edge.to) continue;
      const auto [t, distance] = place_on(a, b, plane.flat[k]);
      if (distance <= plane.near && t > 0 && t < 1) on.emplace_back(t, k);
    }
    on.emplace_back(1.0, edge.to);
    std::sort(on.begin(), on.end());
    for (size_t k = 0; k + 1 < on.size(); ++k) {
      const uint32_t p = on[k].second, q = on[k + 1].second;
      std::vector<uint32_t>& of = outlines[{std::min(p, q), std::max(p, q)}];
      // A part that runs along it twice lies on both of its sides, or on neither.
      if (const auto found = std::find(of.begin(), of.end(), edge.part); found != of.end())
        of.erase(found);
      else
        of.push_back(edge.part);
    }
  }
  std::erase_if(outlines, [](const auto& entry) { return entry.second.empty(); });
  return outlines;
}

// Cells of the plane that segments bound. Half edges: 2 k runs from the lower corner of segment k to the
// higher, 2 k + 1 back; a cell lies on their left. A loop is a border of a cell.
struct Cells {
  std::vector<Segment> segment;
  std::vector<uint32_t> next;               // a row a half edge, along its loop
  std::vector<uint32_t> loop;               // a row a half edge
  std::vector<std::vector<uint32_t>> half;  // a row a loop
  std::vector<double> area;                 // a row a loop: above 0 for the outer border of a cell
  std::vector<uint32_t> cell;  // a row a loop: the loop that is its cell's outer border, or kNone
};

uint32_t start_of(const Cells& cells, uint32_t half) {
  return half % 2 == 0 ? cells.segment[half / 2].first : cells.segment[half / 2].second;
}

// Is a point that lies on no edge of the loop inside of it?
bool is_inside(const Cells& cells, const std::vector<DVec2>& flat, uint32_t loop, DVec2 p) {
  bool inside = false;
  for (const uint32_t half : cells.half[loop]) {
    const DVec2 a = flat[start_of(cells, half)], b = flat[start_of(cells, half ^ 1)];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

Cells find_cells(std::vector<Segment> segments, const std::vector<DVec2>& flat) {
  Cells cells;
  cells.segment = std::move(segments);
  const auto count = static_cast<uint32_t>(2 * cells.segment.size());
  // Around each corner by angle.
  std::vector<std::vector<uint32_t>> leaving(flat.size());
  for (uint32_t half = 0; half < count; ++half) leaving[start_of(cells, half)].push_back(half);
  const auto angle = [&](uint32_t half) {
    const DVec2 d = flat[start_of(cells, half ^ 1)] - flat[start_of(cells, half)];
    return std::atan2(d.y, d.x);
  };
  cells.next.resize(count);
  for (std::vector<uint32_t>& star : leaving) {
    std::sort(star.begin(), star.end(), [&](uint32_t a, uint32_t b) { return angle(a) < angle(b); });
    // What arrives turns left as far as it can: into the one clockwise of where it came from.
    for (size_t k = 0; k < star.size(); ++k)
      cells.next[star[k] ^ 1] = star[(k + star.size() - 1) % star.size()];
  }
  cells.loop.assign(count, kNone);
  for (uint32_t first = 0; first < count; ++first) {
    if (cells.loop[first] != kNone) continue;
    const auto loop = static_cast<uint32_t>(cells.half.size());
    cells.half.emplace_back();
    double twice = 0;
    const DVec2 base = flat[start_of(cells, first)];
    for (uint32_t half = first; cells.loop[half] == kNone; half = cells.next[half]) {
      cells.loop[half] = loop;
      cells.half.back().push_back(half);
      twice += turn(base, flat[start_of(cells, half)], flat[start_of(cells, half ^ 1)]);
    }
    cells.area.push_back(twice / 2);
  }
  cells.cell.assign(cells.half.size(), kNone);
  for (uint32_t loop = 0; loop < cells.half.size(); ++loop) {
    if (cells.area[loop] > 0) {
      cells.cell[loop] = loop;
      continue;
    }
    // The loop around a group of outlines from outside: it is a hole in the smallest cell around it that the
    // group is no part of.
    const DVec2 p = flat[start_of(cells, cells.half[loop][0])];
    double smallest = 1e300;
    for (uint32_t other = 0; other < cells.half.size(); ++other) {
      if (!(cells.area[other] > 0) || cells.area[other] >= smallest) continue;
      const bool touches =
          std::any_of(cells.half[other].begin(), cells.half[other].end(), [&](uint32_t half) {
            return cells.loop[half ^ 1] == loop ||
                   start_of(cells, half) == start_of(cells, cells.half[loop][0]);
          });
      if (touches || !is_inside(cells, flat, other, p)) continue;
      smallest = cells.area[other];
      cells.cell[loop] = other;
    }
  }
  return cells;
}

// Whose surface is on either side.
struct Owners {
  uint32_t up = kNone, down = kNone;
  bool operator==(const Owners&) const = default;
};

class OwnerFinder {
 public:
  explicit OwnerFinder(std::span<const SheetPart> parts) : parts_(parts) {}
  Owners operator()(const std::vector<uint8_t>& covers) const {
    Owners owners;
    for (uint32_t part = 0; part < parts_.size(); ++part) {
      if (!covers[part]) continue;
      const SheetPart& p = parts_[part];
      const bool is_up = glm::dot(p.flat.normal, parts_[0].flat.normal) > 0;
      if (is_up || p.two_sided) owners.up = choose(owners.up, part);
      if (!is_up || p.two_sided) owners.down = choose(owners.down, part);
    }
    return owners;
  }

 private:
  double area(uint32_t part) const {
    return parts_[part].flat.area * parts_[part].flat.size * parts_[part].flat.size;
  }
  uint32_t choose(uint32_t before, uint32_t part) const {
    return before != kNone && area(before) < area(part) * kSmaller ? before : part;
  }
  std::span<const SheetPart> parts_;
};

// Of each loop: who owns its cell. From outside, where nobody is, over one outline after the other.
std::vector<Owners> find_owners(const Cells& cells, const Outlines& outlines,
                                std::span<const SheetPart> parts) {
  const OwnerFinder owners_of(parts);
  const size_t count = cells.half.size();
  std::vector<std::vector<uint32_t>> loops(count);  // of each cell, at its outer border
  for (uint32_t loop = 0; loop < count; ++loop)
    if (cells.cell[loop] != kNone) loops[cells.cell[loop]].push_back(loop);
  std::vector<std::vector<uint8_t>> covers(count);  // of each loop; empty: not reached yet
  std::vector<uint32_t> open;
  const auto reach = [&](uint32_t loop, const std::vector<uint8_t>& cover) {
    if (!covers[loop].empty()) return;
    if (cells.cell[loop] == kNone) {
      covers[loop] = cover, open.push_back(loop);
      return;
    }
    for (const uint32_t same : loops[cells.cell[loop]]) covers[same] = cover, open.push_back(same);
  };
  for (uint32_t loop = 0; loop < count; ++loop)
    if (cells.cell[loop] == kNone) reach(loop, std::vector<uint8_t>(parts.size(), 0));
  while (!open.empty()) {
    const uint32_t loop = open.back();
    open.pop_back();
    for (const uint32_t half : cells.half[loop]) {
      std::vector<uint8_t> cover = covers[loop];
      for (const uint32_t part : outlines.at(cells.segment[half / 2])) cover[part] ^= 1;
      reach(cells.loop[half ^ 1], cover);
    }
  }
  std::vector<Owners> owners(count);
  for (uint32_t loop = 0; loop < count; ++loop)
    if (!covers[loop].empty()) owners[loop] = owners_of(covers[loop]);
  return owners;
}

// The segments that still part two owners, and, of each, those on the left of its two half edges.
struct Borders {
  std::vector<Segment> segment;
  std::vector<std::array<Owners, 2>> owners;
};

Borders keep_borders(const Cells& cells, const std::vector<Owners>& owners) {
  Borders borders;
  for (uint32_t k = 0; k < cells.segment.size(); ++k) {
    const Owners left = owners[cells.loop[2 * k]], right = owners[cells.loop[2 * k + 1]];
    if (left == right) continue;
    borders.segment.push_back(cells.segment[k]);
    borders.owners.push_back({left, right});
  }
  return borders;
}

// Corners on a straight border where no third region begins are left out.
void join_straight(Borders& borders, const Plane& plane) {
  for (bool again = true; again;) {
    again = false;
    std::vector<std::vector<uint32_t>> at(plane.flat.size());
    for (uint32_t k = 0; k < borders.segment.size(); ++k)
      for (const uint32_t corner : {borders.segment[k].first, borders.segment[k].second})
        at[corner].push_back(k);
    std::vector<uint8_t> gone(borders.segment.size(), 0);
    for (uint32_t corner = 0; corner < at.size(); ++corner) {
      if (at[corner].size() != 2) continue;
      const uint32_t a = at[corner][0], b = at[corner][1];
      if (gone[a] || gone[b]) continue;
      const auto other = [&](uint32_t k) {
        return borders.segment[k].first == corner ? borders.segment[k].second : borders.segment[k].first;
      };
      const uint32_t from = other(a), to = other(b);
      const auto [t, distance] = place_on(plane.flat[from], plane.flat[to], plane.flat[corner]);
      if (from == to || !(t > 0 && t < 1) || distance > 1e-12) continue;
      // Left of the way from -> corner.
      const bool up = borders.segment[a].first == from;
      const Owners left = borders.owners[a][up ? 0 : 1], right = borders.owners[a][up ? 1 : 0];
      const Segment joined{std::min(from, to), std::max(from, to)};
      borders.segment[a] = joined;
      borders.owners[a] = from < to ? std::array{left, right} : std::array{right, left};
      gone[b] = 1;
      at[to].erase(std::find(at[to].begin(), at[to].end(), b));
      at[to].push_back(a);
      again = true;
    }
    Borders kept;
    for (size_t k = 0; k < gone.size(); ++k)
      if (!gone[k]) kept.segment.push_back(borders.segment[k]), kept.owners.push_back(borders.owners[k]);
    borders = std::move(kept);
  }
}

// A region as a polygon of its own: the outer loop, then the holes in it.
FlatPolygon make_region(const Cells& cells, uint32_t outer, const Plane& plane) {
  FlatPolygon region;
  region.origin = plane.base.origin, region.size = plane.base.size, region.normal = plane.base.normal;
  region.axis_u = plane.base.axis_u, region.axis_v = plane.base.axis_v;
  region.off_plane = plane.base.off_plane;
  region.ring_first = {0};
  const auto add_ring = [&](uint32_t loop) {
    for (const uint32_t half : cells.half[loop]) {
      region.points.push_back(plane.point[start_of(cells, half)]);
      region.flat.push_back(plane.flat[start_of(cells, half)]);
    }
    region.ring_first.push_back(static_cast<uint32_t>(region.points.size()));
    region.area += cells.area[loop];
  };
  add_ring(outer);
  for (uint32_t loop = 0; loop < cells.cell.size(); ++loop)
    if (loop != outer && cells.cell[loop] == outer) add_ring(loop);
  DVec2 sum(0);
  for (const DVec2& p : region.flat) sum += p;
  region.centroid = sum / static_cast<double>(region.flat.size());
  return region;
}

// Cuts the regions `which`, which share borders: to one grid, or into triangles of their own corners.
bool cut_beside(const std::vector<FlatPolygon>& flats, const std::vector<size_t>& which,
                std::vector<SheetRegion>& regions) {
  if (which.empty()) return true;
  std::vector<FlatPolygon> beside;
  for (const size_t k : which) beside.push_back(flats[k]);
  std::vector<CutFaces> cuts(which.size());
  const bool is_grid = flats[which[0]].off_plane <= kQuadFlatMax && cut_grids(beside, cuts);
  for (size_t k = 0; k < which.size(); ++k) {
    if (!is_grid) {
      cuts[k].points = beside[k].points;
      if (!triangulate(beside[k], cuts[k].faces)) return false;
      flip_to_delaunay(beside[k].flat, cuts[k].faces);
      if (beside[k].off_plane <= kQuadFlatMax) merge_to_quads(beside[k].flat, cuts[k].faces);
    }
    regions[which[k]].cut = std::move(cuts[k]);
  }
  return true;
}

}  // namespace

bool cut_sheet(std::span<const SheetPart> parts, double near, std::vector<SheetRegion>& regions) {
  size_t edge_count = 0;
  for (const SheetPart& part : parts) edge_count += part.flat.points.size();
  if (parts.empty() || edge_count > kSheetEdgesMax) return false;
  Plane plane{parts[0].flat, near / parts[0].flat.size, {}, {}};
  const std::vector<Edge> edges = list_edges(parts, plane);
  if (!add_crossings(edges, plane)) return false;
  const Outlines outlines = split_edges(edges, plane);
  std::vector<Segment> segments;
  for (const auto& entry : outlines) segments.push_back(entry.first);
  const Cells parted = find_cells(std::move(segments), plane.flat);
  Borders borders = keep_borders(parted, find_owners(parted, outlines, parts));
  join_straight(borders, plane);
  const Cells cells = find_cells(borders.segment, plane.flat);
  std::vector<SheetRegion> made;
  std::vector<FlatPolygon> flats;
  std::vector<uint32_t> region_count(parts.size(), 0);
  for (uint32_t loop = 0; loop < cells.half.size(); ++loop) {
    if (!(cells.area[loop] > 0)) continue;
    const uint32_t half = cells.half[loop][0];
    const Owners owners = borders.owners[half / 2][half % 2];
    if (owners == Owners{}) continue;
    made.push_back({owners.up, owners.down, {}});
    flats.push_back(make_region(cells, loop, plane));
    if (owners.up != kNone) ++region_count[owners.up];
    if (owners.down != kNone && owners.down != owners.up) ++region_count[owners.down];
  }
  // What is a polygon's only region may get corners of its own; others meet their neighbours' there.
  std::vector<size_t> beside;
  for (size_t k = 0; k < made.size(); ++k) {
    SheetRegion& region = made[k];
    const auto is_whole = [&](uint32_t part) { return part == kNone || region_count[part] == 1; };
    const auto emits = [&](uint32_t part) { return part != kNone && parts[part].emits; };
    if (!is_whole(region.up) || !is_whole(region.down))
      beside.push_back(k);
    else if (!cut_polygon(flats[k], emits(region.up) || emits(region.down), region.cut))
      return false;
  }
  if (!cut_beside(flats, beside, made)) return false;
  regions = std::move(made);
  return true;
}

}  // namespace patchlight
