// The double integral of ln r along two outlines.
#include "engine/factors/contour.h"

#include <array>

namespace patchlight {
namespace {

constexpr int kHalvingsMax = 40;
// Edges as good as perpendicular to each other exchange nothing.
constexpr double kPerpendicular = 1e-13;

// Of the outlines' lengths: what a sum of logarithms cannot tell.
constexpr double kRounding = 1e-14;

// Kronrod's rules on [-1, 1]: the weight of the middle, then pairs of nodes; Gauss's rule uses every second
// node.
struct Pair {
  double node, weight, gauss_weight;
};
struct Rule {
  double weight, gauss_weight;
  std::span<const Pair> pairs;
};
constexpr std::array<Pair, 3> kPairs7 = {{{0.434243749346802558, 0.401397414775962223, 0},
                                          {0.774596669241483377, 0.268488089868333441, 5.0 / 9},
                                          {0.960491268708020283, 0.104656226026467265, 0}}};
constexpr std::array<Pair, 7> kPairs15 = {{{0.207784955007898468, 0.204432940075298892, 0},
                                           {0.405845151377397167, 0.190350578064785410, 0.381830050505118945},
                                           {0.586087235467691130, 0.169004726639267903, 0},
                                           {0.741531185599394440, 0.140653259715525919, 0.279705391489276668},
                                           {0.864864423359769073, 0.104790010322250184, 0},
                                           {0.949107912342758525, 0.063092092629978553, 0.129484966168869693},
                                           {0.991455371120812640, 0.022935322010529225, 0}}};
const Rule kRule7 = {0.450916538658474142, 8.0 / 9, kPairs7};
const Rule kRule15 = {0.209482141084727828, 0.417959183673469388, kPairs15};

// The integral of ln(r / scale) along all edges of the one outline, from a point of an edge of the other.
struct Integrand {
  std::span<const ContourScratch::Edge> edges;
  DVec3 start, along;
  double scale_squared_inverse;

  double operator()(double t) const {
    const DVec3 p = start + t * along;
    double sum = 0, log_end = 0;
    for (const auto& edge : edges) {
      const DVec3 way = edge.start - p;
      const DVec3 across = cross(way, edge.along);
      const double before = dot(way, edge.along), after = before + edge.length;
      const double away_squared = dot(across, across), away = std::sqrt(away_squared);
      const double log_start = edge.follows ? log_end : find_log(away_squared + before * before);
      log_end = find_log(away_squared + after * after);
      sum += edge.cosine * (0.5 * (after * log_end - before * log_start) +
                            away * std::atan2(away * edge.length, away_squared + before * after));
    }
    return sum;
  }
  // Where r is 0 it stands beside a factor that is 0, too.
  double find_log(double squared) const {
    return squared > 0 ? std::log(squared * scale_squared_inverse) : 0;
  }
};

struct Estimate {
  double value, error;
};
Estimate apply_rule(const Integrand& f, double low, double high, const Rule& rule) {
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low), centre = f(middle);
  double kronrod = rule.weight * centre, gauss = rule.gauss_weight * centre;
  for (const Pair& pair : rule.pairs) {
    const double both = f(middle - half * pair.node) + f(middle + half * pair.node);
    kronrod += pair.weight * both, gauss += pair.gauss_weight * both;
  }
  return {half * kronrod, half * std::abs(kronrod - gauss)};
}

double integrate(const Integrand& f, double low, double high, double tolerance_per_length, int halvings) {
  const double tolerance = tolerance_per_length * (high - low);
  const Estimate quick = apply_rule(f, low, high, kRule7);
  if (quick.error <= tolerance) return quick.value;
  const Estimate fine = apply_rule(f, low, high, kRule15);
  if (fine.error <= tolerance || halvings == kHalvingsMax) return fine.value;
  const double middle = 0.5 * (low + high);
  return integrate(f, low, middle, tolerance_per_length, halvings + 1) +
         integrate(f, middle, high, tolerance_per_length, halvings + 1);
}

// The edges of an outline that are not perpendicular to `along`.
void pick_edges(std::vector<ContourScratch::Edge>& edges, std::span<const Segment> outline, DVec3 along) {
  edges.clear();
  const Segment* last = nullptr;
  for (const Segment& segment : outline) {
    const DVec3 way = segment.end - segment.start;
    const double size = length(way);
    if (size == 0) continue;
    const double cosine = dot(way, along) / size;
    if (std::abs(cosine) <= kPerpendicular) continue;
    edges.push_back({segment.start, way / size, size, cosine, last != nullptr && last->end == segment.start});
    last = &segment;
  }
}

}  // namespace

double find_exchange_area(std::span<const Segment> a, std::span<const Segment> b, double tolerance,
                          ContourScratch& scratch) {
  if (a.empty() || b.empty()) return 0;
  double length_a = 0, length_b = 0;
  DVec3 centre_a(0), centre_b(0);
  for (const Segment& segment : a) length_a += length(segment.end - segment.start), centre_a += segment.start;
  for (const Segment& segment : b) length_b += length(segment.end - segment.start), centre_b += segment.start;
  const DVec3 way = centre_a / static_cast<double>(a.size()) - centre_b / static_cast<double>(b.size());
  // Any constant beside ln r cancels on closed outlines; this one keeps the terms of far pairs small.
  const double scale_squared_inverse = 1 / std::max(dot(way, way), 1e-300);
  // Never finer than rounding, or halving would find no end.
  const double tolerance_per_length =
      std::max(2 * std::numbers::pi * tolerance / std::max(length_a, 1e-300), kRounding * length_b);
  double sum = 0;
  for (const Segment& segment : a) {
    const DVec3 edge = segment.end - segment.start;
    const double size = length(edge);
    if (size == 0) continue;
    const DVec3 along = edge / size;
    pick_edges(scratch.edges, b, along);
    if (scratch.edges.empty()) continue;
    sum += integrate({scratch.edges, segment.start, along, scale_squared_inverse}, 0, size,
                     tolerance_per_length, 0);
  }
  return std::max(sum / (2 * std::numbers::pi), 0.0);
}

}  // namespace patchlight
