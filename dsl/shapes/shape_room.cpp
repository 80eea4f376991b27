// room: the sides of a box from inside, ID.floor to ID.back, some left out, some with materials of their own.
#include "dsl/report/limits.h"
#include "dsl/shapes/shape.h"
#include "dsl/shapes/sides.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

constexpr KeyRow kRows[] = {
    {"size", ValueType::kVec3, true, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Lengths along x, y, z."},
    {"at", ValueType::kVec3, false, "0 0 0", -kAnyNumber, kAnyNumber, "out-of-range", "", "The low corner."},
    {"omit", ValueType::kChoices, false, "", 0, 0, "bad-name", "floor|ceiling|left|right|front|back",
     "Sides that are left out."},
    {"walls", ValueType::kMap, false, "", 0, 0, "", "walls", "Materials by side, where not the object's."},
};

// Rows as kSideNames.
constexpr KeyRow kWallRows[] = {
    {"floor", ValueType::kText, false, "", 0, 0, "", "", "Material of the floor (low y)."},
    {"ceiling", ValueType::kText, false, "", 0, 0, "", "", "Material of the ceiling (high y)."},
    {"left", ValueType::kText, false, "", 0, 0, "", "", "Material of the left wall (low x)."},
    {"right", ValueType::kText, false, "", 0, 0, "", "", "Material of the right wall (high x)."},
    {"front", ValueType::kText, false, "", 0, 0, "", "", "Material of the front wall (high z)."},
    {"back", ValueType::kText, false, "", 0, 0, "", "", "Material of the back wall (low z)."},
};

constexpr KeyTable kKeys = {"room", kRows};
constexpr KeyTable kInner[] = {{"walls", kWallRows}};

void build(const ShapeInput& input) {
  const Context& context = input.context;
  const Tree& tree = context.tree;
  const MapValues map = read_map(context, input.node, kKeys);
  if (!map.good) return;
  constexpr size_t kSideCount = kSideNames.size();
  std::array<bool, kSideCount> omitted{};
  std::array<uint32_t, kSideCount> material;
  std::array<bool, kSideCount> named{};
  material.fill(input.own.material);
  if (const uint32_t list = value_of(map, "omit").node; list != kNone) {
    KeyRow row = row_of(kKeys, "omit");
    row.type = ValueType::kChoice;
    for (uint32_t child = tree.nodes[list].first; child != kNone; child = tree.nodes[child].next)
      if (Value side; read_value(context, child, row, side))
        omitted[static_cast<size_t>(side.integer[0])] = true;
  }
  if (const uint32_t node = value_of(map, "walls").node; node != kNone) {
    const MapValues walls = read_map(context, node, kInner[0]);
    for (size_t side = 0; side < kSideCount; ++side) {
      const uint32_t wall = walls.values[side].node;
      named[side] = wall != kNone;
      if (named[side] && walls.good) material[side] = find_material(context, wall, input.scene.materials);
    }
    if (!walls.good) return;
  }
  const DVec3 low = vec3_of(value_of(map, "at")), high = low + vec3_of(value_of(map, "size"));
  for (size_t side = 0; side < kSideCount; ++side) {
    if (omitted[side]) continue;
    if (!named[side] && !require_material(input)) return;
    add_polygon(input.scene.outlines, input.object_row, fmt::format("{}.{}", input.id, kSideNames[side]),
                material[side], input.node, side_corners(side, low, high, true));
  }
}

}  // namespace

extern const ShapeRow kRoomShape = {
    .name = "room",
    .keys = &kKeys,
    .inner = kInner,
    .build = build,
    .description = "A box whose sides face inward; sides can be left out.",
};

}  // namespace patchlight
