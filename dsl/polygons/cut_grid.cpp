// Rectilinear polygons (walls with windows) to a grid of rectangles.
#include "dsl/polygons/cut.h"
#include "dsl/polygons/ring_check.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kParallel = 1e-9;    // an edge's slope to its direction, and lines nearer than this are one
constexpr double kFinest = 1.0 / 16;  // lines are added down to this share of the polygon's longer side
constexpr double kCellStretch = 1.5;  // cells may be so much longer than the narrowest gap

// The different values among `values`, ascending.
std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> lines;
  for (const double value : values)
    if (lines.empty() || value - lines.back() > kParallel) lines.push_back(value);
  return lines;
}

// Lines along one direction and along the other, ascending.
struct Lines {
  std::vector<double> xs, ys;
};

// Adds those of the polygon's corners, in no order; false when an edge follows neither direction.
bool add_lines(const FlatPolygon& polygon, Lines& lines) {
  for (size_t ring = 0; ring < polygon.ring_count(); ++ring) {
    const uint32_t first = polygon.ring_first[ring], last = polygon.ring_first[ring + 1];
    for (uint32_t k = first; k < last; ++k) {
      const DVec2 a = polygon.flat[k], edge = glm::abs(polygon.flat[k + 1 < last ? k + 1 : first] - a);
      if (std::min(edge.x, edge.y) > kParallel) return false;
      lines.xs.push_back(a.x);
      lines.ys.push_back(a.y);
    }
  }
  return true;
}

size_t pieces_of(double gap, double cell) {
  return std::max<size_t>(1, static_cast<size_t>(std::lround(gap / cell)));
}

// Lines added between the given ones so that gaps come near to `cell`.
std::vector<double> refine(const std::vector<double>& lines, double cell) {
  std::vector<double> finer;
  for (size_t k = 0; k + 1 < lines.size(); ++k) {
    const size_t pieces = pieces_of(lines[k + 1] - lines[k], cell);
    for (size_t j = 0; j < pieces; ++j)
      finer.push_back(lines[k] +
                      (lines[k + 1] - lines[k]) * static_cast<double>(j) / static_cast<double>(pieces));
  }
  finer.push_back(lines.back());
  return finer;
}

double narrowest_gap(const std::vector<double>& lines) {
  double gap = 1e300;
  for (size_t k = 0; k + 1 < lines.size(); ++k) gap = std::min(gap, lines[k + 1] - lines[k]);
  return gap;
}

size_t line_index(const std::vector<double>& lines, double value) {
  const auto at = std::lower_bound(lines.begin(), lines.end(), value - kParallel);
  return static_cast<size_t>(at - lines.begin());
}

size_t cell_count(const std::vector<double>& xs, const std::vector<double>& ys) {
  return (xs.size() - 1) * (ys.size() - 1);
}

// For each cell of row `y` whether it is inside: the crossings of the row's middle line, by the even-odd
// rule.
std::vector<uint8_t> inside_of_row(const FlatPolygon& polygon, const std::vector<double>& xs, double y) {
  std::vector<double> crossings;
  for (size_t ring = 0; ring < polygon.ring_count(); ++ring) {
    const uint32_t first = polygon.ring_first[ring], last = polygon.ring_first[ring + 1];
    for (uint32_t k = first; k < last; ++k) {
      const DVec2 a = polygon.flat[k], b = polygon.flat[k + 1 < last ? k + 1 : first];
      if ((a.y > y) != (b.y > y)) crossings.push_back((a.x + b.x) / 2);
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<uint8_t> inside(xs.size() - 1, 0);
  for (size_t k = 0; k + 1 < crossings.size(); k += 2)
    for (size_t x = line_index(xs, crossings[k]); x < line_index(xs, crossings[k + 1]); ++x) inside[x] = 1;
  return inside;
}

// The lines of all polygons, and those added between them. False when they make no grid.
bool find_lines(std::span<const FlatPolygon> polygons, Lines& lines) {
  for (const FlatPolygon& polygon : polygons)
    if (!add_lines(polygon, lines)) return false;
  std::vector<double> xs = distinct(std::move(lines.xs)), ys = distinct(std::move(lines.ys));
  if (cell_count(xs, ys) > kGridCellsMax) return false;
  const double longer_side = std::max(xs.back() - xs.front(), ys.back() - ys.front());
  const double cell =
      kCellStretch * std::max(std::min(narrowest_gap(xs), narrowest_gap(ys)), kFinest * longer_side);
  lines = {refine(xs, cell), refine(ys, cell)};
  if (cell_count(lines.xs, lines.ys) > kGridCellsMax) lines = {std::move(xs), std::move(ys)};
  return true;
}

void cut_at_lines(const FlatPolygon& polygon, const Lines& lines, CutFaces& cut) {
  const std::vector<double>&xs = lines.xs, &ys = lines.ys;
  // The polygon's own corners keep their bits; other grid points are made where a cell needs them.
  std::vector<uint32_t> point(xs.size() * ys.size(), kNone);
  for (uint32_t k = 0; k < polygon.flat.size(); ++k)
    point[line_index(ys, polygon.flat[k].y) * xs.size() + line_index(xs, polygon.flat[k].x)] = k;
  const auto point_of = [&](size_t x, size_t y) {
    uint32_t& index = point[y * xs.size() + x];
    if (index == kNone) {
      index = static_cast<uint32_t>(cut.points.size());
      cut.points.push_back(point_at(polygon, DVec2(xs[x], ys[y])));
    }
    return index;
  };
  for (size_t y = 0; y + 1 < ys.size(); ++y) {
    const std::vector<uint8_t> inside = inside_of_row(polygon, xs, (ys[y] + ys[y + 1]) / 2);
    for (size_t x = 0; x + 1 < xs.size(); ++x)
      if (inside[x])
        cut.faces.push_back({point_of(x, y), point_of(x + 1, y), point_of(x + 1, y + 1), point_of(x, y + 1)});
  }
}

}  // namespace

bool cut_grid(const FlatPolygon& polygon, CutFaces& cut) {
  Lines lines;
  if (!find_lines({&polygon, 1}, lines)) return false;
  cut_at_lines(polygon, lines, cut);
  return true;
}

bool cut_grids(std::span<const FlatPolygon> polygons, std::span<CutFaces> cuts) {
  Lines lines;
  if (!find_lines(polygons, lines)) return false;
  for (size_t k = 0; k < polygons.size(); ++k) {
    cuts[k].points = polygons[k].points;
    cut_at_lines(polygons[k], lines, cuts[k]);
  }
  return true;
}

}  // namespace patchlight
