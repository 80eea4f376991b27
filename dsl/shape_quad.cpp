// quad: a rectangle by centre, size and normal, or a parallelogram by origin, u and v.
#include "limits.h"
#include "shapes.h"

#include <cmath>

namespace patchlight {
namespace {

using enum ValueType;

constexpr KeyRow kRows[] = {
    {"size", kVec2, false, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Width and height. Required with center and normal."},
    {"center", kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Middle of the rectangle."},
    {"normal", kVec3, false, "0 1 0", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Towards the lit side, any length. The width lies along x where it can."},
    {"origin", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "A corner; then u and v are required."},
    {"u", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the next corner."},
    {"v", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Edge from origin to the last corner; the lit side is u x v."},
};

void report(const ShapeInput& input, uint32_t node, std::string_view slug, std::string message) {
  add_error(input.context.messages, place_of(input.context.tree, node), slug, std::move(message));
}

// Unit vectors along width and height for a unit normal: width x height = normal.
void make_axes(DVec3 normal, DVec3& width, DVec3& height) {
  const bool along_x = std::abs(normal.x) > 0.999;
  const DVec3 wish = along_x ? DVec3(0, 0, normal.x > 0 ? -1 : 1) : DVec3(1, 0, 0);
  width = glm::normalize(wish - normal * glm::dot(wish, normal));
  height = glm::cross(normal, width);
}

}  // namespace

const KeyTable kQuadKeys = {"quad", kRows};

void build_quad(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kQuadKeys);
  if (!require_material(input) || !map.good) return;
  const bool by_edges = has(map, "origin") || has(map, "u") || has(map, "v");
  const bool by_centre = has(map, "size") || has(map, "center") || has(map, "normal");
  if (by_edges && by_centre)
    return report(input, input.node, "ambiguous-shape",
                  "a quad has either center, size, normal or origin, u, v");
  if (by_edges) {
    for (const std::string_view key : {"origin", "u", "v"})
      if (!has(map, key))
        return report(input, input.node, "missing-key", "a quad by edges needs origin, u and v");
    const DVec3 origin = vec3_of(value_of(map, "origin")), u = vec3_of(value_of(map, "u")),
                v = vec3_of(value_of(map, "v"));
    const DVec3 corners[] = {origin, origin + u, origin + u + v, origin + v};
    return add_polygon(input.outlines, input.object_row, input.id, input.material, input.node, corners);
  }
  if (!has(map, "size"))
    return report(input, input.node, "missing-key", "a quad needs its size: [width, height]");
  const DVec3 direction = vec3_of(value_of(map, "normal"));
  const double largest_part = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (largest_part == 0)
    return report(input, value_of(map, "normal").node, "zero-axis", "the normal has no length");
  DVec3 width, height;
  make_axes(glm::normalize(direction / largest_part), width, height);
  const double* size = value_of(map, "size").number;
  const DVec3 half_w = width * (size[0] / 2), half_h = height * (size[1] / 2),
              center = vec3_of(value_of(map, "center"));
  const DVec3 corners[] = {center - half_w - half_h, center + half_w - half_h, center + half_w + half_h,
                           center - half_w + half_h};
  add_polygon(input.outlines, input.object_row, input.id, input.material, input.node, corners);
}

}  // namespace patchlight
