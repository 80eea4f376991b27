// room: the sides of a box from inside, ID.floor to ID.back, some left out, some with materials of their own.
#include "limits.h"
#include "shapes.h"
#include "sides.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

constexpr KeyRow kRows[] = {
    {"size", ValueType::kVec3, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Lengths along x, y, z."},
    {"at", ValueType::kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "", "The low corner."},
    {"omit", ValueType::kList, false, "", 0, 0, "", "",
     "Sides that are left out: floor, ceiling, left, right, front, back."},
    {"walls", ValueType::kMap, false, "", 0, 0, "", "*", "Materials by side, where not the object's."},
};

// The number of the side that a scalar names; reports `slug` and returns the count of sides otherwise.
size_t find_side(const Context& context, uint32_t node, std::string_view slug) {
  const std::string_view word = text_of(context.tree, node);
  for (size_t side = 0; side < kSideNames.size(); ++side)
    if (kSideNames[side] == word) return side;
  add_error(context.messages, place_of(context.tree, node), slug,
            fmt::format("sides are floor, ceiling, left, right, front, back; got {}",
                        describe(context.tree, node)));
  return kSideNames.size();
}

}  // namespace

const KeyTable kRoomKeys = {"room", kRows};

void build_room(const ShapeInput& input) {
  const Context& context = input.context;
  const Tree& tree = context.tree;
  const MapValues map = read_map(context, input.node, kRoomKeys);
  if (!map.good) return;
  std::array<bool, kSideNames.size() + 1> omitted{};
  std::array<uint32_t, kSideNames.size() + 1> material;
  std::array<bool, kSideNames.size() + 1> named{};
  material.fill(input.own.material);
  if (const uint32_t list = value_of(map, "omit").node; list != kNone)
    for (uint32_t child = tree.nodes[list].first; child != kNone; child = tree.nodes[child].next)
      omitted[find_side(context, child, "bad-name")] = true;
  if (const uint32_t walls = value_of(map, "walls").node; walls != kNone)
    for (uint32_t key = tree.nodes[walls].first; key != kNone;) {
      const uint32_t value = tree.nodes[key].next;
      const size_t side = find_side(context, key, "unknown-key");
      named[side] = true;
      material[side] = find_material(context, value, input.scene.materials);
      key = tree.nodes[value].next;
    }
  const DVec3 low = vec3_of(value_of(map, "at")), high = low + vec3_of(value_of(map, "size"));
  for (size_t side = 0; side < kSideNames.size(); ++side) {
    if (omitted[side]) continue;
    if (!named[side] && !require_material(input)) return;
    add_polygon(input.scene.outlines, input.object_row, fmt::format("{}.{}", input.id, kSideNames[side]),
                material[side], input.node, side_corners(side, low, high, true));
  }
}

}  // namespace patchlight
