// The list `objects` to polygons: shared keys here, the shapes in their own files.
#include "objects.h"

#include "limits.h"
#include "shapes.h"

#include <fmt/format.h>

#include <unordered_map>

namespace patchlight {
namespace {

// The one shape that an object names; nullptr after an error.
const ShapeRow* find_shape(const Context& context, const MapValues& object) {
  const ShapeRow* found = nullptr;
  std::string known;
  for (const ShapeRow& shape : shape_rows()) {
    known += (known.empty() ? "" : ", ") + std::string(shape.name);
    if (!has(object, shape.name)) continue;
    if (found) {
      add_error(context.messages, place_of(context.tree, object.node), "ambiguous-shape",
                fmt::format("an object has one shape; this one has '{}' and '{}'", found->name, shape.name));
      return nullptr;
    }
    found = &shape;
  }
  if (!found)
    add_error(context.messages, place_of(context.tree, object.node), "missing-key",
              fmt::format("an object needs a shape: one of {}", known));
  return found;
}

void read_object(const Context& context, uint32_t node, const std::string& default_id,
                 MaterialTable& materials, ObjectTable& objects, OutlineTable& outlines) {
  const MapValues map = read_map(context, node, object_keys());
  if (!map.good) return;
  const ShapeRow* shape = find_shape(context, map);
  if (!shape) return;
  if (has(map, "holes") && shape->name != "polygon") {
    add_error(context.messages, place_of(context.tree, value_of(map, "holes").node), "unknown-key",
              fmt::format("'holes' goes with 'polygon', not with '{}'", shape->name));
    return;
  }
  const Value& id_value = value_of(map, "id");
  const std::string id =
      id_value.node != kNone ? std::string(text_of(context.tree, id_value.node)) : default_id;
  uint32_t material = kNone;
  if (const uint32_t name = value_of(map, "material").node; name != kNone) {
    material = find_material(context, name, materials);
    if (material == kNone) return;
  }
  const auto row = static_cast<uint32_t>(objects.size());
  const Value& subdivide = value_of(map, "subdivide");
  objects.node.push_back(id_value.node != kNone ? id_value.node : node);
  objects.two_sided.push_back(static_cast<uint8_t>(value_of(map, "two_sided").integer[0]));
  objects.patch_size.push_back(has(map, "patch_size") ? value_of(map, "patch_size").number[0] : 0);
  objects.subdivide.push_back(subdivide.node != kNone ? static_cast<uint32_t>(subdivide.integer[0]) : 1);
  objects.subdivide_node.push_back(subdivide.node);
  shape->build({context, map, value_of(map, shape->name).node, row, id, material, materials, outlines});
  if (outlines.size() > kPolygonsMax)
    add_error(context.messages, place_of(context.tree, node), "too-many-polygons",
              fmt::format("more than the limit of {} polygons", kPolygonsMax));
}

}  // namespace

void read_objects(const Context& context, uint32_t list, MaterialTable& materials, ObjectTable& objects,
                  OutlineTable& outlines) {
  const Tree& tree = context.tree;
  if (tree.nodes[list].count == 0)
    add_error(context.messages, place_of(tree, list), "empty-scene", "the scene has no objects");
  size_t number = 0;
  for (uint32_t child = tree.nodes[list].first; child != kNone; child = tree.nodes[child].next) {
    read_object(context, child, fmt::format("object{}", ++number), materials, objects, outlines);
    if (outlines.size() > kPolygonsMax) return;
  }
}

void check_ids(const Context& context, const ObjectTable& objects, const OutlineTable& outlines) {
  std::unordered_map<std::string_view, uint32_t> first;
  first.reserve(outlines.size());
  uint32_t reported = kNone;  // one message an object, however many parts it has
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const auto [row, is_new] = first.try_emplace(outlines.id[p], p);
    if (is_new || outlines.object[p] == reported) continue;
    reported = outlines.object[p];
    const Place before = place_of(context.tree, objects.node[outlines.object[row->second]]);
    add_error(context.messages, place_of(context.tree, objects.node[outlines.object[p]]), "duplicate-id",
              fmt::format("the id '{}' is taken: first defined at {}:{}", escape_text(outlines.id[p]),
                          before.line, before.column));
  }
}

}  // namespace patchlight
