// An outline checked and laid flat. All tolerances are shares of the polygon's own size.
#include "dsl/polygons/flatten.h"

#include "dsl/polygons/plane_check.h"
#include "dsl/polygons/ring_check.h"
#include "dsl/report/limits.h"
#include "dsl/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kRepeated = 1e-9;  // corners nearer than this are one, in units of the polygon's size

std::string corner_text(DVec3 p) {
  return fmt::format("[{}, {}, {}]", number_text(p.x), number_text(p.y), number_text(p.z));
}

// The place of a corner in the file, where the ring is a list of corners; else of what stands for the ring.
Place corner_place(const Tree& tree, const OutlineTable& outlines, uint32_t ring, uint32_t corner) {
  const uint32_t node = outlines.ring_node[ring];
  const uint32_t count = outlines.ring_first[ring + 1] - outlines.ring_first[ring];
  const bool listed = tree.nodes[node].kind == NodeKind::kList && tree.nodes[node].count == count;
  return place_of(tree, listed ? child_of(tree, node, corner) : node);
}

// Copies a ring without corners that repeat the one before, and without a last that repeats the first.
void copy_ring(Messages& messages, const Tree& tree, const OutlineTable& outlines, uint32_t ring, double near,
               FlatPolygon& polygon, std::vector<uint32_t>& kept) {
  const uint32_t begin = outlines.ring_first[ring], end = outlines.ring_first[ring + 1];
  const size_t first = polygon.points.size();
  const auto same = [&](DVec3 a, DVec3 b) { return glm::length(a - b) <= near; };
  for (uint32_t k = begin; k < end; ++k) {
    const DVec3 point = outlines.corners[k];
    if (polygon.points.size() > first && same(point, polygon.points.back())) {
      // To find a corner's place is to walk there.
      const bool wanted = wants_warnings(messages, "repeated-vertex");
      add_warning(messages, wanted ? corner_place(tree, outlines, ring, k - begin) : Place{},
                  "repeated-vertex",
                  fmt::format("corner {} of {} repeats the one before; dropped", k - begin + 1, end - begin));
      continue;
    }
    polygon.points.push_back(point);
    kept.push_back(k - begin);
  }
  if (polygon.points.size() > first + 1 && same(polygon.points.back(), polygon.points[first])) {
    add_warning(messages, corner_place(tree, outlines, ring, end - begin - 1), "closed-ring",
                "the last corner repeats the first; dropped, rings close by themselves");
    polygon.points.pop_back();
    kept.pop_back();
  }
  polygon.ring_first.push_back(static_cast<uint32_t>(polygon.points.size()));
}

// The plane of the outline, and all points on it. False when the outline has no area.
bool lay_flat(FlatPolygon& polygon) {
  const size_t outline_count = polygon.ring_first[1];
  const DVec3 normal_sum = newell(polygon.points, 0, outline_count, polygon.points[0], polygon.size);
  if (glm::length(normal_sum) / 2 < kAreaMin) return false;
  polygon.normal = glm::normalize(normal_sum);
  DVec3 middle(0);
  for (size_t k = 0; k < outline_count; ++k)
    middle += (polygon.points[k] - polygon.points[0]) / static_cast<double>(outline_count);
  polygon.origin = polygon.points[0] + middle;
  // The plane's axes follow the longest edge, so that rectangles lie straight.
  double longest = 0;
  DVec3 along(0);
  for (size_t k = 0; k < outline_count; ++k) {
    const DVec3 edge = (polygon.points[(k + 1) % outline_count] - polygon.points[k]) / polygon.size;
    const DVec3 in_plane = edge - polygon.normal * glm::dot(edge, polygon.normal);
    if (glm::length(in_plane) > longest * (1 + 1e-9)) longest = glm::length(in_plane), along = in_plane;
  }
  polygon.axis_u = glm::normalize(along);
  polygon.axis_v = glm::cross(polygon.normal, polygon.axis_u);
  polygon.off_plane = 0;
  polygon.flat.clear();
  for (const DVec3& point : polygon.points) {
    const DVec3 offset = (point - polygon.origin) / polygon.size;
    polygon.flat.emplace_back(glm::dot(offset, polygon.axis_u), glm::dot(offset, polygon.axis_v));
    polygon.off_plane = std::max(polygon.off_plane, std::abs(glm::dot(offset, polygon.normal)));
  }
  return true;
}

// Turns holes clockwise, and sums area and centroid over all rings.
void orient_and_measure(FlatPolygon& polygon) {
  polygon.area = 0;
  DVec2 moment(0);
  for (size_t ring = 0; ring < polygon.ring_count(); ++ring) {
    const uint32_t first = polygon.ring_first[ring], last = polygon.ring_first[ring + 1];
    const DVec2 base = polygon.flat[first];
    double twice = 0;
    DVec2 ring_moment(0);
    for (uint32_t k = first + 1; k + 1 < last; ++k) {
      const double piece = turn(base, polygon.flat[k], polygon.flat[k + 1]);
      twice += piece;
      ring_moment += (base + polygon.flat[k] + polygon.flat[k + 1]) * (piece / 6);
    }
    const bool reverse = ring > 0 && twice > 0;
    if (reverse) {
      std::reverse(polygon.points.begin() + first, polygon.points.begin() + last);
      std::reverse(polygon.flat.begin() + first, polygon.flat.begin() + last);
    }
    polygon.area += (reverse ? -1 : 1) * twice / 2;
    moment += ring_moment * (reverse ? -1.0 : 1.0);
  }
  polygon.centroid = moment / polygon.area;
}

struct FaultText {
  std::string_view slug, text;
};
FaultText fault_text(RingFault fault) {
  switch (fault) {
    case RingFault::kHoleOutside:
      return {"hole-outside", "the hole reaches outside of the polygon"};
    case RingFault::kHoleTouches:
      return {"hole-touches", "the hole touches the polygon's edge; make the outline go round it instead"};
    case RingFault::kHolesOverlap:
      return {"holes-overlap", "two holes touch or overlap; make them one"};
    default:
      return {"self-intersecting", "the polygon's outline crosses or touches itself"};
  }
}

// One polygon of the table, and where to say what is wrong with it.
struct Subject {
  Messages& messages;
  const Tree& tree;
  const OutlineTable& outlines;
  uint32_t polygon;
  uint32_t ring_begin, ring_end;
  std::vector<uint32_t> kept;  // of each point that copy_ring kept: its number in its ring

  Place ring_place(uint32_t ring) const { return place_of(tree, outlines.ring_node[ring_begin + ring]); }
  Place outline_corner_place(size_t point) const {
    return corner_place(tree, outlines, ring_begin, kept[point]);
  }
};

bool report(const Subject& subject, Place place, std::string_view slug, std::string_view message) {
  add_error(subject.messages, place, slug,
            fmt::format("'{}': {}", escape_text(subject.outlines.id[subject.polygon]), message));
  return false;
}

// Checks the coordinates and copies the rings. False after coordinate-too-large or zero-area.
bool copy_rings(Subject& subject, FlatPolygon& polygon) {
  const OutlineTable& outlines = subject.outlines;
  const Limits& limits = subject.messages.limits;
  const uint32_t count = outlines.ring_first[subject.ring_end] - outlines.ring_first[subject.ring_begin];
  if (count > limits.corners)
    return report(subject, subject.ring_place(0), "too-many-polygons",
                  fmt::format("{} corners, those of its holes included, more than the limit of {}", count,
                              limit_text(limits, &Limits::corners)));
  DVec3 low(outlines.corners[outlines.ring_first[subject.ring_begin]]), high = low;
  for (uint32_t ring = subject.ring_begin; ring < subject.ring_end; ++ring)
    for (uint32_t k = outlines.ring_first[ring]; k < outlines.ring_first[ring + 1]; ++k) {
      const DVec3 point = outlines.corners[k];
      if (!(std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) <= kCoordinateMax))
        return report(
            subject, corner_place(subject.tree, outlines, ring, k - outlines.ring_first[ring]),
            "coordinate-too-large",
            fmt::format("{} is beyond the limit of {}", corner_text(point), number_text(kCoordinateMax)));
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
  polygon.points.clear();
  polygon.ring_first.assign(1, 0);
  polygon.of_mesh = polygon.only_triangles = false;
  const double largest_side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (!(largest_side > 0))
    return report(subject, subject.ring_place(0), "zero-area",
                  "all corners are the same point: the polygon has no area");
  polygon.size = glm::length((high - low) / largest_side) * largest_side;
  for (uint32_t ring = subject.ring_begin; ring < subject.ring_end; ++ring) {
    copy_ring(subject.messages, subject.tree, outlines, ring, kRepeated * polygon.size, polygon,
              subject.kept);
    const size_t rings = polygon.ring_count();
    if (polygon.ring_first[rings] - polygon.ring_first[rings - 1] < 3)
      return report(subject, place_of(subject.tree, outlines.ring_node[ring]), "zero-area",
                    fmt::format("fewer than 3 different corners: the {} has no area",
                                ring > subject.ring_begin ? "hole" : "polygon"));
  }
  return true;
}

bool report_non_planar(const Subject& subject, const FlatPolygon& polygon) {
  if (const uint32_t ring = ring_off_plane(polygon); ring > 0)
    return report(
        subject, subject.ring_place(ring), "non-planar",
        fmt::format("the hole lies off the polygon's plane by {:.2g} % of its size, the limit is 2 %",
                    polygon.off_plane * 100));
  const size_t worst = corner_to_blame(polygon);
  const auto& first = subject.outlines.ring_first;
  return report(
      subject, subject.outline_corner_place(worst), "non-planar",
      fmt::format("corner {} of {}, {}, is too far off the plane of the others: corners lie up to {:.2g} % "
                  "of the polygon's size off one plane, the limit is 2 %",
                  subject.kept[worst] + 1, first[subject.ring_begin + 1] - first[subject.ring_begin],
                  corner_text(polygon.points[worst]), polygon.off_plane * 100));
}

// True for triangles and convex quads, the common case, which cannot cross themselves.
bool is_convex_and_small(const FlatPolygon& polygon) {
  const size_t count = polygon.flat.size();
  if (polygon.ring_count() > 1 || count > 4) return false;
  for (size_t k = 0; k < count; ++k)
    if (turn(polygon.flat[k], polygon.flat[(k + 1) % count], polygon.flat[(k + 2) % count]) <= 0)
      return false;
  return true;
}

// False after zero-area: a hole whose corners lie on a line.
bool check_hole_areas(const Subject& subject, const FlatPolygon& polygon) {
  for (uint32_t ring = 1; ring < polygon.ring_count(); ++ring) {
    FlatPolygon hole;
    hole.points.assign(polygon.points.begin() + polygon.ring_first[ring],
                       polygon.points.begin() + polygon.ring_first[ring + 1]);
    for (const DVec3& point : hole.points)
      hole.size = std::max(hole.size, glm::length(point - hole.points[0]));
    if (is_on_line(hole))
      return report(subject, subject.ring_place(ring), "zero-area",
                    "the hole has no area: its corners lie on a line");
  }
  return true;
}

bool check_outline(const Subject& subject, const FlatPolygon& polygon) {
  if (is_convex_and_small(polygon)) return true;
  if (!check_hole_areas(subject, polygon)) return false;
  const RingCheck check = check_rings(polygon);
  if (check.fault == RingFault::kNoFault) return true;
  const FaultText text = fault_text(check.fault);
  return report(subject,
                check.ring == 0 ? subject.outline_corner_place(check.corner) : subject.ring_place(check.ring),
                text.slug, fmt::format("{}, near {}", text.text, corner_text(polygon.points[check.corner])));
}

}  // namespace

bool flatten_polygon(Messages& messages, const Tree& tree, const OutlineTable& outlines, uint32_t p,
                     FlatPolygon& polygon) {
  Subject subject{messages, tree, outlines, p, outlines.polygon_first[p], outlines.polygon_first[p + 1], {}};
  if (!copy_rings(subject, polygon)) return false;
  const Place place = subject.ring_place(0);
  if (!lay_flat(polygon)) {
    // A bow tie has no area by sum, but its corners do not lie on a line.
    if (!is_on_line(polygon))
      return report(subject, place, "self-intersecting", "the polygon's outline crosses itself");
    return report(subject, place, "zero-area", "the polygon has no area: its corners lie on a line");
  }
  if (polygon.off_plane > kNonPlanarMax) return report_non_planar(subject, polygon);
  orient_and_measure(polygon);
  if (!check_outline(subject, polygon)) return false;
  if (!(polygon.area > kAreaMin)) return report(subject, place, "zero-area", "the polygon has no area");
  if (polygon.off_plane > kFlatMax)
    add_warning(
        messages, place, "non-planar",
        fmt::format(
            "'{}': corners lie up to {:.2g} % of the polygon's size off one plane; cut into triangles",
            escape_text(outlines.id[p]), polygon.off_plane * 100));
  return true;
}

bool flatten_again(const OutlineTable& outlines, uint32_t p, FlatPolygon& polygon) {
  // Places are asked for where there is something to say: one node stands for them all.
  Messages unheard;
  Tree tree;
  tree.file_first = {0};
  tree.nodes.resize(1);
  OutlineTable copy;
  const uint32_t first = outlines.polygon_first[p], last = outlines.polygon_first[p + 1];
  add_polygon(copy, 0, {}, kNone, 0, ring_of(outlines, first));
  for (uint32_t ring = first + 1; ring < last; ++ring) add_hole(copy, 0, ring_of(outlines, ring));
  return flatten_polygon(unheard, tree, copy, 0, polygon);
}

MeshFace flatten_mesh_face(std::span<const DVec3> corners, FlatPolygon& polygon) {
  polygon.points.clear();
  polygon.of_mesh = true;
  polygon.only_triangles = false;
  if (corners.size() < 3) return MeshFace::kNoArea;
  DVec3 low(corners[0]), high = low;
  for (const DVec3& point : corners) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  const double largest_side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (!(largest_side > 0)) return MeshFace::kNoArea;
  polygon.size = glm::length((high - low) / largest_side) * largest_side;
  const auto same = [&](DVec3 a, DVec3 b) { return glm::length(a - b) <= kRepeated * polygon.size; };
  for (const DVec3& point : corners)
    if (polygon.points.empty() || !same(point, polygon.points.back())) polygon.points.push_back(point);
  while (polygon.points.size() > 1 && same(polygon.points.back(), polygon.points[0]))
    polygon.points.pop_back();
  if (polygon.points.size() < 3) return MeshFace::kNoArea;
  polygon.ring_first = {0, static_cast<uint32_t>(polygon.points.size())};
  if (!lay_flat(polygon)) return MeshFace::kNoArea;
  orient_and_measure(polygon);
  if (!(polygon.area > kAreaMin)) return MeshFace::kNoArea;
  if (is_convex_and_small(polygon) || check_rings(polygon).fault == RingFault::kNoFault)
    return MeshFace::kSound;
  polygon.only_triangles = true;
  return MeshFace::kCrossing;
}

}  // namespace patchlight
