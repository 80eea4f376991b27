// Moving, turning and stretching of polygons.
#include "dsl/shapes/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

DVec3 linear(const Transform& t, DVec3 p) { return t.x * p.x + t.y * p.y + t.z * p.z; }

// Sine and cosine of degrees, exact at quarter turns.
void sine_cosine(double degrees, double& sine, double& cosine) {
  const double turn = std::remainder(degrees, 360);
  const double radians = turn * std::numbers::pi / 180;
  sine = std::fmod(turn, 180) == 0 ? 0 : std::sin(radians);
  cosine = std::abs(std::fmod(turn, 180)) == 90 ? 0 : std::cos(radians);
}

bool read_axis(const Context& context, uint32_t node, DVec3& axis) {
  const std::string_view word = text_of(context.tree, node);
  if (word == "x" || word == "y" || word == "z") {
    axis = DVec3(word == "x", word == "y", word == "z");
    return true;
  }
  Value value;
  value.node = node;
  return read_three(context, node, "expected-vec3", value.number) && read_direction(context, value, axis);
}

bool read_rotation(const Context& context, uint32_t node, Transform& transform) {
  const MapValues map = read_map(context, node, kRotateKeys);
  DVec3 axis;
  if (!map.good || !read_axis(context, value_of(map, "axis").node, axis)) return false;
  double sine = 0, cosine = 1;
  sine_cosine(value_of(map, "angle").number[0], sine, cosine);
  const auto turned = [&](DVec3 p) {  // Rodrigues
    return p * cosine + glm::cross(axis, p) * sine + axis * (glm::dot(axis, p) * (1 - cosine));
  };
  transform = {turned(DVec3(1, 0, 0)), turned(DVec3(0, 1, 0)), turned(DVec3(0, 0, 1)), DVec3(0)};
  return true;
}

bool read_scale(const Context& context, uint32_t node, Transform& transform) {
  double number[3] = {1, 1, 1};
  if (context.tree.nodes[node].kind == NodeKind::kList) {
    if (!read_three(context, node, "expected-vec3", number)) return false;
  } else if (!read_number(context, node, number[0])) {
    return false;
  } else {
    number[1] = number[2] = number[0];
  }
  if (number[0] == 0 || number[1] == 0 || number[2] == 0) {
    add_error(context.messages, place_of(context.tree, node), "singular-transform",
              "a scale of 0 leaves nothing of the object");
    return false;
  }
  transform = {DVec3(number[0], 0, 0), DVec3(0, number[1], 0), DVec3(0, 0, number[2]), DVec3(0)};
  return true;
}

// The steps that a map names, in the order scale, rotate, translate.
bool read_steps(const Context& context, const MapValues& map, Transform& transform) {
  Transform step;
  if (const uint32_t node = value_of(map, "scale").node; node != kNone) {
    if (!read_scale(context, node, step)) return false;
    transform = combine(transform, step);
  }
  if (const uint32_t node = value_of(map, "rotate").node; node != kNone) {
    if (!read_rotation(context, node, step)) return false;
    transform = combine(transform, step);
  }
  if (has(map, "translate")) transform.shift += vec3_of(value_of(map, "translate"));
  return true;
}

}  // namespace

Transform combine(const Transform& first, const Transform& second) {
  return {linear(second, first.x), linear(second, first.y), linear(second, first.z),
          linear(second, first.shift) + second.shift};
}

bool read_transform(const Context& context, uint32_t list, Transform& transform) {
  const Tree& tree = context.tree;
  for (uint32_t child = tree.nodes[list].first; child != kNone; child = tree.nodes[child].next) {
    const MapValues map = read_map(context, child, kTransformKeys);
    if (!map.good || !read_steps(context, map, transform)) return false;
  }
  return true;
}

bool read_object_transform(const Context& context, const MapValues& object, Transform& transform,
                           bool& found) {
  const bool by_keys = has(object, "translate") || has(object, "rotate") || has(object, "scale");
  const uint32_t list = value_of(object, "transform").node;
  found = by_keys || list != kNone;
  return list != kNone ? read_transform(context, list, transform) : read_steps(context, object, transform);
}

void apply_transform(const Transform& transform, uint32_t node, size_t first_polygon,
                     OutlineTable& outlines) {
  const size_t first_ring = outlines.polygon_first[first_polygon];
  const auto corners = outlines.corners.begin();
  for (size_t k = outlines.ring_first[first_ring]; k < outlines.corners.size(); ++k)
    outlines.corners[k] = linear(transform, outlines.corners[k]) + transform.shift;
  if (glm::dot(glm::cross(transform.x, transform.y), transform.z) > 0) return;
  for (size_t ring = first_ring; ring < outlines.ring_node.size(); ++ring) {
    std::reverse(corners + outlines.ring_first[ring], corners + outlines.ring_first[ring + 1]);
    outlines.ring_node[ring] = node;  // its corners no longer follow the file's
  }
}

}  // namespace patchlight
