// What the builders of shapes share.
#include "dsl/shapes/shape.h"

#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <cmath>

namespace patchlight {

bool require_material(const ShapeInput& input) {
  if (input.own.material != kNone) return true;
  add_error(input.context.messages, place_of(input.context.tree, input.object.node), "missing-key",
            fmt::format("object '{}' needs a material", escape_text(input.id)));
  return false;
}

void add_part(const ShapeInput& input, std::string_view part, std::span<const DVec3> corners) {
  add_polygon(input.scene.outlines, input.object_row, input.id + std::string(part), input.own.material,
              input.node, corners);
}

bool read_corners(const Context& context, uint32_t node, std::string_view what, std::vector<DVec3>& corners) {
  const Tree& tree = context.tree;
  if (tree.nodes[node].kind != NodeKind::kList) {
    add_error(context.messages, place_of(tree, node), "expected-list",
              fmt::format("expected a list of corners for {}, got {}", what, describe(tree, node)));
    return false;
  }
  const uint32_t count = tree.nodes[node].count;
  if (count < 3) {
    add_error(context.messages, place_of(tree, node), "too-few-vertices",
              fmt::format("{} needs at least 3 corners, got {}", what, count));
    return false;
  }
  const Limits& limits = context.messages.limits;
  if (count > limits.corners) {
    add_error(context.messages, place_of(tree, node), "too-many-polygons",
              fmt::format("{} has {} corners, more than the limit of {}", what, count,
                          limit_text(limits, &Limits::corners)));
    return false;
  }
  bool good = true;
  corners.clear();
  for (uint32_t child = tree.nodes[node].first; child != kNone; child = tree.nodes[child].next) {
    double number[3] = {0, 0, 0};
    good = read_three(context, child, "expected-vec3", number) && good;
    corners.emplace_back(number[0], number[1], number[2]);
  }
  return good;
}

void make_axes(DVec3 normal, DVec3& width, DVec3& height) {
  const bool along_x = std::abs(normal.x) > 0.999;
  const DVec3 wish = along_x ? DVec3(0, 0, normal.x > 0 ? -1 : 1) : DVec3(1, 0, 0);
  width = glm::normalize(wish - normal * glm::dot(wish, normal));
  height = glm::cross(normal, width);
}

}  // namespace patchlight
