// The shapes of the language: one row each, one file each (shape_<name>.cpp).
#pragma once

#include "language.h"
#include "materials.h"
#include "outlines.h"
#include "values.h"

#include <span>
#include <string>
#include <string_view>

namespace patchlight {

// What a shape is built from and into. All polygons are in the object's own coordinates.
struct ShapeInput {
  const Context& context;
  const MapValues& object;  // the object's map, its shared keys checked
  uint32_t node;            // the shape's value: what stands behind `quad:`
  uint32_t object_row;      // row of ObjectTable
  const std::string& id;    // of the object; parts are ID.part
  uint32_t material;        // row of the object's material, kNone: none named
  MaterialTable& materials;
  OutlineTable& outlines;  // written
};

struct ShapeRow {
  std::string_view name;
  const KeyTable* keys;              // of its map; nullptr: its value is no map
  void (*build)(const ShapeInput&);  // appends polygons, or reports errors
  bool material_optional;            // it can do without `material` on the object
  std::string_view description;
};

std::span<const ShapeRow> shape_rows();

// True where the object names a material; reports missing-key otherwise.
bool require_material(const ShapeInput& input);

// The builders, and the tables of those shapes that are maps.
void build_polygon(const ShapeInput& input);
void build_quad(const ShapeInput& input);
void build_box(const ShapeInput& input);
void build_room(const ShapeInput& input);
extern const KeyTable kQuadKeys;
extern const KeyTable kBoxKeys;
extern const KeyTable kRoomKeys;

}  // namespace patchlight
