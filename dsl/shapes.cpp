// The list of shapes. A new one is its file and its row here.
#include "shapes.h"

#include <fmt/format.h>

namespace patchlight {

std::span<const ShapeRow> shape_rows() {
  static constexpr ShapeRow kRows[] = {
      {"polygon", nullptr, build_polygon, false,
       "List of corners [x, y, z], counter-clockwise from the lit side."},
      {"quad", &kQuadKeys, build_quad, false,
       "A rectangle by centre, size and normal, or a parallelogram by origin, u, v."},
      {"box", &kBoxKeys, build_box, false, "A box whose six sides face outward."},
      {"room", &kRoomKeys, build_room, true, "A box whose sides face inward; sides can be left out."},
  };
  return kRows;
}

bool require_material(const ShapeInput& input) {
  if (has(input.object, "material")) return true;
  add_error(input.context.messages, place_of(input.context.tree, input.object.node), "missing-key",
            fmt::format("object '{}' needs a material", escape_text(input.id)));
  return false;
}

}  // namespace patchlight
