// Appends to the table of outlines.
#include "dsl/polygons/outlines.h"

namespace patchlight {

void add_polygon(OutlineTable& outlines, uint32_t object, std::string id, uint32_t material, uint32_t node,
                 std::span<const DVec3> corners) {
  outlines.id.push_back(std::move(id));
  outlines.object.push_back(object);
  outlines.material.push_back(material);
  outlines.polygon_first.push_back(outlines.polygon_first.back());
  add_hole(outlines, node, corners);  // the outline is the first ring
}

void add_hole(OutlineTable& outlines, uint32_t node, std::span<const DVec3> corners) {
  outlines.corners.insert(outlines.corners.end(), corners.begin(), corners.end());
  outlines.ring_first.push_back(static_cast<uint32_t>(outlines.corners.size()));
  outlines.ring_node.push_back(node);
  ++outlines.polygon_first.back();
}

}  // namespace patchlight
