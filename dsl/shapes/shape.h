// What a shape of the language is, and what the builders of shapes share.
#pragma once

#include "dsl/language/language.h"
#include "dsl/language/values.h"
#include "dsl/shapes/scene_objects.h"

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

// A shape: its keys, with all that the schema, the messages and completion say of them, and its builder. Each
// stands in the shape's own file.
struct ShapeRow {
  std::string_view name = {};
  ValueType type = ValueType::kMap;            // of what stands behind its name
  const KeyTable* keys = nullptr;              // of its map; nullptr: its value is no map
  std::span<const KeyTable> inner = {};        // of the maps in that map
  std::span<const KeyRow> beside = {};         // keys of the object that go with this shape only
  void (*build)(const ShapeInput&) = nullptr;  // appends polygons, or reports errors
  std::string_view description = {};
};

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

}  // namespace patchlight
