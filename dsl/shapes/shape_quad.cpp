// quad: a rectangle by centre, size and normal, or a parallelogram by origin, u and v.
#include "dsl/shapes/quad.h"

namespace patchlight {
namespace {

constexpr KeyTable kKeys = {"quad", kQuadRows, kQuadRules};

void build(const ShapeInput& input) {
  const MapValues map = read_map(input.context, input.node, kKeys);
  std::array<DVec3, 4> corners;
  if (require_material(input) && map.good && read_quad(input.context, map, corners))
    add_part(input, "", corners);
}

}  // namespace

extern const ShapeRow kQuadShape = {
    .name = "quad",
    .keys = &kKeys,
    .build = build,
    .description = "A rectangle by center, size and normal, or a parallelogram by origin, u, v.",
};

}  // namespace patchlight
