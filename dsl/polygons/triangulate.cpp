// Ear clipping: flat polygons with holes to triangles of their own corners.
#include "dsl/polygons/triangulate.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kEarMin = 1e-13;        // twice an ear's area, in units of size squared: below it is a line
constexpr double kSlopeTie = 1e-9;       // bridges whose slopes differ by less are on one line
constexpr double kAreaTolerance = 1e-9;  // the triangles' sum against the polygon, share of the area

// A ring of corners, linked both ways. Bridges visit a corner twice: then it has two links.
struct Link {
  uint32_t point, before, after;
};

// Corners that may lie in an ear, by the cell of a grid: an ear asks only the cells that it covers.
struct BlockerGrid {
  DVec2 low{0};
  double cell = 1;
  uint32_t side = 1;
  std::vector<uint32_t> first, links;

  uint32_t index(double x, double from) const {
    const double k = (x - from) / cell;
    return k <= 0 ? 0 : std::min(side - 1, static_cast<uint32_t>(k));
  }
};

struct Clipper {
  const FlatPolygon& polygon;
  std::vector<Link> links;
  std::vector<uint8_t> gone;
  BlockerGrid grid;

  DVec2 at(uint32_t link) const { return polygon.flat[links[link].point]; }
  double turn_at(uint32_t link) const {
    return turn(at(links[link].before), at(link), at(links[link].after));
  }
};

// Links the corners of one ring; returns its first link.
uint32_t link_ring(Clipper& clipper, uint32_t ring) {
  const uint32_t first = clipper.polygon.ring_first[ring], last = clipper.polygon.ring_first[ring + 1];
  const auto base = static_cast<uint32_t>(clipper.links.size());
  const uint32_t count = last - first;
  for (uint32_t k = 0; k < count; ++k)
    clipper.links.push_back({first + k, base + (k + count - 1) % count, base + (k + 1) % count});
  return base;
}

// A little beyond the edges too: a corner on the edge that two ears share must not fall between them by
// rounding.
bool in_triangle(DVec2 a, DVec2 b, DVec2 c, DVec2 p) {
  return turn(a, b, p) >= -kEarMin && turn(b, c, p) >= -kEarMin && turn(c, a, p) >= -kEarMin;
}

// True when the direction from `link` to p leaves into the polygon's inside.
bool is_locally_inside(const Clipper& clipper, uint32_t link, DVec2 p) {
  const DVec2 here = clipper.at(link), before = clipper.at(clipper.links[link].before),
              after = clipper.at(clipper.links[link].after);
  if (turn(before, here, after) > 0) return turn(here, p, after) <= 0 && turn(here, before, p) <= 0;
  return turn(here, p, before) > 0 || turn(here, after, p) > 0;
}

// The corner of the outline that a hole's leftmost corner can be joined to: the nearest edge to the left,
// then the corner that lies in between at the flattest angle.
uint32_t find_bridge(const Clipper& clipper, uint32_t hole_link, uint32_t outline) {
  const DVec2 p = clipper.at(hole_link);
  double nearest = -1e300;
  uint32_t found = kNone;
  uint32_t link = outline;
  do {
    const uint32_t after = clipper.links[link].after;
    const DVec2 a = clipper.at(link), b = clipper.at(after);
    if (a.y >= p.y && b.y <= p.y && a.y != b.y) {  // inside lies to the right of edges that run down
      const double x = a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y);
      if (x <= p.x && x > nearest) {
        nearest = x;
        found = a.x < b.x ? link : after;
        if (x == p.x) return found;
      }
    }
    link = after;
  } while (link != outline);
  if (found == kNone) return kNone;
  const DVec2 hit(nearest, p.y);
  const DVec2 m = clipper.at(found);
  const uint32_t stop = found;
  double flattest = 1e300;
  uint32_t best = found;
  link = found;
  do {
    const DVec2 q = clipper.at(link);
    const bool between = q.x <= p.x && q.x >= m.x && q.x != p.x;
    const bool covered = p.y < m.y ? in_triangle(p, m, hit, q) : in_triangle(hit, m, p, q);
    if (between && (covered || link == stop)) {
      const double slope = std::abs(p.y - q.y) / (p.x - q.x);
      // Of corners on one line the nearer one: a bridge may not run through a corner.
      const bool nearer = slope < flattest + kSlopeTie && q.x > clipper.at(best).x;
      if (is_locally_inside(clipper, link, p) && (slope < flattest - kSlopeTie || nearer)) {
        best = link;
        flattest = slope;
      }
    }
    link = clipper.links[link].after;
  } while (link != stop);
  return best;
}

// Cuts the polygon open along a bridge between a corner of the outline and one of a hole.
void join_hole(Clipper& clipper, uint32_t outline_link, uint32_t hole_link) {
  const auto outline_again = static_cast<uint32_t>(clipper.links.size());
  const uint32_t hole_again = outline_again + 1;
  const uint32_t outline_after = clipper.links[outline_link].after,
                 hole_before = clipper.links[hole_link].before;
  clipper.links.push_back({clipper.links[outline_link].point, hole_again, outline_after});
  clipper.links.push_back({clipper.links[hole_link].point, hole_before, outline_again});
  clipper.links[outline_link].after = hole_link;
  clipper.links[hole_link].before = outline_link;
  clipper.links[outline_after].before = outline_again;
  clipper.links[hole_before].after = hole_again;
}

bool join_holes(Clipper& clipper, uint32_t outline) {
  std::vector<uint32_t> leftmost;
  for (uint32_t ring = 1; ring < clipper.polygon.ring_count(); ++ring) {
    const uint32_t base = link_ring(clipper, ring);
    uint32_t left = base;
    for (uint32_t link = base; link < clipper.links.size(); ++link) {
      const DVec2 p = clipper.at(link), q = clipper.at(left);
      if (p.x < q.x || (p.x == q.x && p.y < q.y)) left = link;
    }
    leftmost.push_back(left);
  }
  std::sort(leftmost.begin(), leftmost.end(), [&](uint32_t a, uint32_t b) {
    const DVec2 p = clipper.at(a), q = clipper.at(b);
    return p.x != q.x ? p.x < q.x : p.y < q.y;
  });
  for (const uint32_t hole : leftmost) {
    const uint32_t bridge = find_bridge(clipper, hole, outline);
    if (bridge == kNone) return false;
    join_hole(clipper, bridge, hole);
  }
  return true;
}

void fill_grid(Clipper& clipper) {
  std::vector<uint32_t> blockers;
  DVec2 low(1e300), high(-1e300);
  for (uint32_t link = 0; link < clipper.links.size(); ++link) {
    low = glm::min(low, clipper.at(link));
    high = glm::max(high, clipper.at(link));
    // Only corners that turn inwards can lie in an ear; clipping never makes a corner turn inwards.
    if (clipper.turn_at(link) <= kEarMin) blockers.push_back(link);
  }
  BlockerGrid& grid = clipper.grid;
  grid.side = std::max<uint32_t>(1, static_cast<uint32_t>(std::sqrt(static_cast<double>(blockers.size()))));
  grid.low = low;
  grid.cell = std::max({high.x - low.x, high.y - low.y, 1e-300}) / grid.side;
  const auto cell_of = [&](uint32_t link) {
    return grid.index(clipper.at(link).y, low.y) * grid.side + grid.index(clipper.at(link).x, low.x);
  };
  grid.first.assign(grid.side * grid.side + 1, 0);
  for (const uint32_t link : blockers) ++grid.first[cell_of(link) + 1];
  for (size_t k = 1; k < grid.first.size(); ++k) grid.first[k] += grid.first[k - 1];
  grid.links.resize(blockers.size());
  std::vector<uint32_t> fill(grid.first.begin(), grid.first.end() - 1);
  for (const uint32_t link : blockers) grid.links[fill[cell_of(link)]++] = link;
}

bool is_ear(const Clipper& clipper, uint32_t link) {
  const Link& ear = clipper.links[link];
  const DVec2 a = clipper.at(ear.before), b = clipper.at(link), c = clipper.at(ear.after);
  if (turn(a, b, c) <= kEarMin) return false;
  const BlockerGrid& grid = clipper.grid;
  const DVec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  for (uint32_t y = grid.index(low.y, grid.low.y); y <= grid.index(high.y, grid.low.y); ++y)
    for (uint32_t x = grid.index(low.x, grid.low.x); x <= grid.index(high.x, grid.low.x); ++x)
      for (uint32_t k = grid.first[y * grid.side + x]; k < grid.first[y * grid.side + x + 1]; ++k) {
        const uint32_t other = grid.links[k];
        if (clipper.gone[other] || other == ear.before || other == ear.after || other == link) continue;
        const DVec2 p = clipper.at(other);
        if (p == a || p == b || p == c) continue;
        if (in_triangle(a, b, c, p) && clipper.turn_at(other) <= kEarMin) return false;
      }
  return true;
}

}  // namespace

bool triangulate(const FlatPolygon& polygon, std::vector<FaceCorners>& triangles) {
  Clipper clipper{polygon, {}, {}, {}};
  uint32_t link = link_ring(clipper, 0);
  if (!join_holes(clipper, link)) return false;
  clipper.gone.assign(clipper.links.size(), 0);
  fill_grid(clipper);
  double area = 0;
  size_t left = clipper.links.size(), refused = 0;
  while (left > 2) {
    const Link ear = clipper.links[link];
    const double twice = clipper.turn_at(link);
    // Nothing is an ear any more: what is left is a line, up to rounding.
    const bool forced = refused > left;
    if (forced || is_ear(clipper, link)) {
      if (twice > 0) {
        triangles.push_back({clipper.links[ear.before].point, ear.point, clipper.links[ear.after].point,
                             clipper.links[ear.after].point});
        area += twice / 2;
      }
      clipper.gone[link] = 1;
      clipper.links[ear.before].after = ear.after;
      clipper.links[ear.after].before = ear.before;
      --left;
      refused = 0;
      link = clipper.links[ear.after].after;  // one is skipped, so that ears do not fan from one corner
    } else {
      ++refused;
      link = ear.after;
    }
  }
  return std::abs(area - polygon.area) <=
         kAreaTolerance * polygon.area + kEarMin * static_cast<double>(polygon.flat.size());
}

}  // namespace patchlight
