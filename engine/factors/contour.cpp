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
// Outlines further apart than so many of the larger one's radii are far.
constexpr double kFar = 1e4;
// An outline so many times larger than the other is cut, at so many of the other's radii.
constexpr double kMuchLarger = 1e4;
constexpr double kNeighbourhood = 64;

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

double find_length(std::span<const Segment> outline) {
  double sum = 0;
  for (const Segment& segment : outline) sum += length(segment.end - segment.start);
  return sum;
}

// The double integral over closed outlines, or over differences of such.
double integrate_outlines(std::span<const Segment> a, std::span<const Segment> b, DVec3 way, double tolerance,
                          ContourScratch& scratch) {
  const double length_a = find_length(a), length_b = find_length(b);
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
  return sum / (2 * std::numbers::pi);
}

// An outline's middle, how far it reaches from there, and its vector of area: along the normal of its lit
// side.
struct Measure {
  DVec3 centre{0}, area{0};
  double radius = 0;
};
Measure measure(std::span<const Segment> outline) {
  Measure m;
  for (const Segment& segment : outline) m.centre += segment.start;
  m.centre /= static_cast<double>(outline.size());
  for (const auto& [start, end] : outline) {
    m.radius = std::max(m.radius, length(start - m.centre));
    m.area += 0.5 * cross(start - m.centre, end - m.centre);
  }
  return m;
}

// Points of the triangles between a middle and the segments of an outline, and the area that each stands for:
// below 0 where the outline runs the other way around the middle, so that sums hold for any outline.
struct Node {
  DVec3 point;
  double weight;
};
struct NodePlace {
  double a, b, weight;  // shares of the second and the third corner; of the area
};
// Exact for what is of the second degree in the place.
constexpr std::array<NodePlace, 3> kMiddles = {{{0.5, 0, 1.0 / 3}, {0.5, 0.5, 1.0 / 3}, {0, 0.5, 1.0 / 3}}};
// Of the fifth degree (Radon: Zur mechanischen Kubatur, 1948).
constexpr double kNear = 0.101286507323456339, kNearFar = 0.797426985353087322;
constexpr double kWide = 0.470142064105115090, kWideFar = 0.059715871789769820;
constexpr double kNearWeight = 0.125939180544827153, kWideWeight = 0.132394152788506181;
constexpr std::array<NodePlace, 7> kRadon = {{{1.0 / 3, 1.0 / 3, 0.225},
                                              {kNear, kNear, kNearWeight},
                                              {kNearFar, kNear, kNearWeight},
                                              {kNear, kNearFar, kNearWeight},
                                              {kWide, kWide, kWideWeight},
                                              {kWideFar, kWide, kWideWeight},
                                              {kWide, kWideFar, kWideWeight}}};

template <class Use>
void for_nodes(std::span<const Segment> outline, const Measure& m, std::span<const NodePlace> places,
               const Use& use) {
  const DVec3 normal = normalize(m.area);
  for (const auto& [start, end] : outline) {
    const DVec3 a = start - m.centre, b = end - m.centre;
    const double area = 0.5 * dot(cross(a, b), normal);
    for (const NodePlace& place : places)
      use(Node{m.centre + place.a * a + place.b * b, area * place.weight});
  }
}

// The kernel, summed: its cosines are of the first degree in either place, and its distance hardly changes.
double sum_far(std::span<const Segment> a, const Measure& of_a, std::span<const Segment> b,
               const Measure& of_b) {
  const DVec3 normal_a = normalize(of_a.area), normal_b = normalize(of_b.area);
  double sum = 0;
  for_nodes(a, of_a, kMiddles, [&](const Node& from) {
    for_nodes(b, of_b, kMiddles, [&](const Node& to) {
      const DVec3 way = to.point - from.point;
      const double squared = dot(way, way);
      sum -= from.weight * to.weight * dot(way, normal_a) * dot(way, normal_b) / (squared * squared);
    });
  });
  return sum / std::numbers::pi;
}

// The factor from a point to what an outline bounds, by Lambert's formula.
double find_point_factor(DVec3 p, DVec3 normal, std::span<const Segment> outline) {
  double sum = 0;
  for (const auto& [start, end] : outline) {
    const DVec3 a = start - p, b = end - p, across = cross(a, b);
    const double size = length(across);
    if (size > 0) sum += std::atan2(size, dot(a, b)) * dot(across, normal) / size;
  }
  return -sum / (2 * std::numbers::pi);
}

// A small outline and one very much larger: what of the large one is near goes by the double integral, the
// rest changes slowly over the small one.
double split_large(std::span<const Segment> small, const Measure& of_small, std::span<const Segment> large,
                   const Measure& of_large, double tolerance, ContourScratch& scratch) {
  const DVec3 normal = normalize(of_large.area);
  const DVec3 some = std::abs(normal.x) < 0.5 ? DVec3(1, 0, 0) : DVec3(0, 1, 0);
  const DVec3 u = normalize(cross(normal, some)), v = cross(normal, u);
  const double reach = kNeighbourhood * of_small.radius;
  std::vector<Segment> near(large.begin(), large.end()), kept;
  for (const DVec3& axis : {u, -u, v, -v}) {
    kept.clear();
    clip_outline(kept, near, {axis, dot(axis, of_small.centre) - reach});
    std::swap(near, kept);
  }
  double sum = 0;
  const DVec3 normal_small = normalize(of_small.area);
  for_nodes(small, of_small, kRadon, [&](const Node& node) {
    sum += node.weight * (find_point_factor(node.point, normal_small, large) -
                          find_point_factor(node.point, normal_small, near));
  });
  if (near.empty()) return sum;
  return sum + integrate_outlines(small, near, DVec3(of_small.radius, 0, 0), tolerance, scratch);
}

}  // namespace

double find_exchange_area(std::span<const Segment> a, std::span<const Segment> b, double tolerance,
                          ContourScratch& scratch) {
  if (a.empty() || b.empty()) return 0;
  const Measure of_a = measure(a), of_b = measure(b);
  const DVec3 way = of_a.centre - of_b.centre;
  const double small = std::min(of_a.radius, of_b.radius), large = std::max(of_a.radius, of_b.radius);
  const bool has_planes = dot(of_a.area, of_a.area) > 0 && dot(of_b.area, of_b.area) > 0;
  double exchange = 0;
  if (has_planes && length(way) > kFar * large)
    exchange = sum_far(a, of_a, b, of_b);
  else if (has_planes && large > kMuchLarger * small)
    exchange = of_a.radius < of_b.radius ? split_large(a, of_a, b, of_b, tolerance, scratch)
                                         : split_large(b, of_b, a, of_a, tolerance, scratch);
  else
    exchange = integrate_outlines(a, b, way, tolerance, scratch);
  return std::max(exchange, 0.0);
}

double find_exchange_rounding(std::span<const Segment> a, std::span<const Segment> b) {
  if (a.empty() || b.empty()) return 0;
  const Measure of_a = measure(a), of_b = measure(b);
  const double small = std::min(of_a.radius, of_b.radius);
  const double reach_a = std::min(find_length(a), 8 * kNeighbourhood * small);
  const double reach_b = std::min(find_length(b), 8 * kNeighbourhood * small);
  return kRounding * std::max(reach_a, 1e-300) * std::max(reach_b, 1e-300);
}

}  // namespace patchlight
