// The keys that quad and grid share, to four corners.
#include "dsl/shapes/quad.h"

namespace patchlight {

bool read_quad(const Context& context, const MapValues& map, std::array<DVec3, 4>& corners) {
  if (has(map, "origin")) {
    const DVec3 origin = vec3_of(value_of(map, "origin")), u = vec3_of(value_of(map, "u")),
                v = vec3_of(value_of(map, "v"));
    corners = {origin, origin + u, origin + u + v, origin + v};
    return true;
  }
  DVec3 normal, width, height;
  if (!read_direction(context, value_of(map, "normal"), normal)) return false;
  make_axes(normal, width, height);
  const double* size = value_of(map, "size").number;
  const DVec3 half_w = width * (size[0] / 2), half_h = height * (size[1] / 2),
              center = vec3_of(value_of(map, "center"));
  corners = {center - half_w - half_h, center + half_w - half_h, center + half_w + half_h,
             center - half_w + half_h};
  return true;
}

}  // namespace patchlight
