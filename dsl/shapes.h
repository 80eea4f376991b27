// The shapes of the language: one row each, one file each (shape_<name>.cpp).
#pragma once

#include "language.h"
#include "materials.h"
#include "objects.h"
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
  const std::string& id;    // of the object; parts are ID.part
  const Inherited& own;     // material and settings of the object; what groups and repeats hand on
  uint32_t object_row;      // row of SceneObjects::objects
  SceneObjects& scene;      // written
};

struct ShapeRow {
  std::string_view name;
  ValueType type;                    // of what stands behind its name
  const KeyTable* keys;              // of its map; nullptr: its value is no map
  void (*build)(const ShapeInput&);  // appends polygons, or reports errors
  std::string_view description;
};

std::span<const ShapeRow> shape_rows();

// True where the object has a material, its own or that of its group; reports missing-key otherwise.
bool require_material(const ShapeInput& input);

// Adds a polygon of the object: `part` is what its id has behind the object's ("", ".floor", ".3").
void add_part(const ShapeInput& input, std::string_view part, std::span<const DVec3> corners);

// Reads a list of corners [x, y, z]; `what` names it in messages. False after expected-list,
// too-few-vertices, too-many-polygons or the errors of read_three.
bool read_corners(const Context& context, uint32_t node, std::string_view what, std::vector<DVec3>& corners);

// Unit vectors along width and height of something flat with a unit normal: width x height = normal, the
// width along x where it can.
void make_axes(DVec3 normal, DVec3& width, DVec3& height);

// The unit vector of a key's value; false after zero-axis.
bool read_direction(const Context& context, const Value& value, DVec3& direction);

// The corners of a rectangle or parallelogram from the keys of kQuadRows; false after errors.
bool read_quad(const ShapeInput& input, const MapValues& map, std::array<DVec3, 4>& corners);

// The builders, and the tables of those shapes that are maps.
void build_polygon(const ShapeInput& input);
void build_quad(const ShapeInput& input);
void build_box(const ShapeInput& input);
void build_room(const ShapeInput& input);
void build_grid(const ShapeInput& input);
void build_disk(const ShapeInput& input);
void build_cylinder(const ShapeInput& input);
void build_prism(const ShapeInput& input);
void build_sphere(const ShapeInput& input);
void build_mesh(const ShapeInput& input);
void build_group(const ShapeInput& input);
void build_repeat(const ShapeInput& input);
extern const KeyTable kGridKeys;
extern const KeyTable kDiskKeys;
extern const KeyTable kCylinderKeys;
extern const KeyTable kPrismKeys;
extern const KeyTable kSphereKeys;
extern const KeyTable kRepeatKeys;
extern const KeyTable kQuadKeys;
extern const KeyTable kBoxKeys;
extern const KeyTable kRoomKeys;
extern const KeyTable kWallKeys;  // of `walls` in a room: one a side

}  // namespace patchlight
