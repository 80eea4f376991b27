// The polygons of a scene as corners, in file units, before they are checked and cut.
#pragma once

#include "engine/base/vector.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace patchlight {

// What all polygons of one object share.
struct ObjectTable {
  std::vector<std::string> top_ids;  // of the entries of the lists `objects`: a row an entry, not an object
  std::vector<uint32_t> top;         // the entry that the object is, or stands in: a row of top_ids
  std::vector<uint32_t> node;        // tree node of its id, or of the object where it has none
  std::vector<uint8_t> two_sided;
  std::vector<uint8_t> is_mesh;    // its polygons are faces of a mesh: bent or thin ones are no mistakes
  std::vector<uint8_t> is_smooth;  // its polygons stand for a curved surface
  std::vector<uint8_t> is_solid;   // its polygons enclose what nothing is to be in
  std::vector<double> patch_size, patch_size_min;  // file units; 0: as the settings say
  std::vector<uint32_t> subdivide;                 // 1: not asked
  std::vector<uint32_t> subdivide_node;
  size_t size() const { return node.size(); }
};

// A polygon has rings: the outline first, then its holes. Rings have corners.
struct OutlineTable {
  std::vector<DVec3> corners;
  std::vector<uint32_t> ring_first{0};     // rings + 1
  std::vector<uint32_t> ring_node;         // tree node that lists the ring's corners (or stands for it)
  std::vector<uint32_t> polygon_first{0};  // polygons + 1: first ring
  std::vector<std::string> id;
  std::vector<uint32_t> object;    // row of ObjectTable
  std::vector<uint32_t> material;  // row of MaterialTable, or kNone after an error
  size_t size() const { return id.size(); }
};

// The corners of a ring.
inline std::span<const DVec3> ring_of(const OutlineTable& outlines, uint32_t ring) {
  return std::span(outlines.corners)
      .subspan(outlines.ring_first[ring], outlines.ring_first[ring + 1] - outlines.ring_first[ring]);
}

// Adds a polygon with its outline, corners counter-clockwise from the lit side.
void add_polygon(OutlineTable& outlines, uint32_t object, std::string id, uint32_t material, uint32_t node,
                 std::span<const DVec3> corners);

// Adds a hole to the last polygon.
void add_hole(OutlineTable& outlines, uint32_t node, std::span<const DVec3> corners);

}  // namespace patchlight
