// The list `objects` to polygons: shared keys here, the shapes in their own files.
#include "dsl/shapes/objects.h"

#include "dsl/report/limits.h"
#include "dsl/shapes/object_keys.h"
#include "dsl/shapes/shapes.h"
#include "dsl/shapes/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <unordered_map>

namespace patchlight {
namespace {

// The one shape that an object names; nullptr after an error.
const ShapeRow* find_shape(const Context& context, const MapValues& object) {
  const ShapeRow* found = nullptr;
  for (const ShapeRow& shape : shape_rows()) {
    if (!has(object, shape.name)) continue;
    if (found) {
      add_error(context.messages, place_of(context.tree, object.node), "ambiguous-shape",
                fmt::format("an object has one shape; this one has '{}' and '{}'", found->name, shape.name));
      return nullptr;
    }
    found = &shape;
  }
  if (found) return found;
  std::string known;
  for (const ShapeRow& shape : shape_rows()) known += (known.empty() ? "" : ", ") + std::string(shape.name);
  add_error(context.messages, place_of(context.tree, object.node), "missing-key",
            fmt::format("an object needs a shape: one of {}", known));
  return nullptr;
}

// What the object says itself, before what it inherits. False after unknown-material.
bool read_own(const Context& context, const MapValues& map, MaterialTable& materials, Inherited& own) {
  if (const uint32_t name = value_of(map, "material").node; name != kNone) {
    own.material = find_material(context, name, materials);
    if (own.material == kNone) return false;
  }
  if (has(map, "two_sided")) own.two_sided = value_of(map, "two_sided").integer[0] != 0;
  if (has(map, "patch_size")) own.patch_size = value_of(map, "patch_size").number[0];
  if (has(map, "patch_size_min")) own.patch_size_min = value_of(map, "patch_size_min").number[0];
  if (has(map, "subdivide")) {
    own.subdivide = static_cast<uint32_t>(
        std::min<int64_t>(value_of(map, "subdivide").integer[0], std::numeric_limits<uint32_t>::max()));
    own.subdivide_node = value_of(map, "subdivide").node;
  }
  return true;
}

uint32_t add_object(uint32_t node, const Inherited& own, ObjectTable& objects) {
  objects.node.push_back(node);
  objects.top.push_back(own.top);
  objects.two_sided.push_back(own.two_sided);
  objects.is_mesh.push_back(0);
  objects.is_smooth.push_back(0);
  objects.is_solid.push_back(0);
  objects.patch_size.push_back(own.patch_size);
  objects.patch_size_min.push_back(own.patch_size_min);
  objects.subdivide.push_back(own.subdivide);
  objects.subdivide_node.push_back(own.subdivide_node);
  return static_cast<uint32_t>(objects.size() - 1);
}

// Reports the first of too many polygons, and then no more.
void check_counts(const Context& context, uint32_t node, SceneObjects& scene) {
  const uint64_t polygons = context.messages.limits.polygons;
  std::string_view what;
  if (scene.objects.size() > kObjectsPerPolygon * polygons) what = ", by the number of objects";
  if (scene.outlines.corners.size() > kCornersPerPolygon * polygons) what = ", by the number of corners";
  const bool plain = scene.outlines.size() > polygons;
  if (scene.is_full || (what.empty() && !plain)) return;
  scene.is_full = true;
  add_error(context.messages, place_of(context.tree, node), "too-many-polygons",
            fmt::format("more than the limit of {}{}", limit_text(context.messages.limits, &Limits::polygons),
                        plain ? "" : what));
}

void report_duplicate_id(const Context& context, uint32_t node, std::string_view id, uint32_t first) {
  const Place place = place_of(context.tree, node);
  add_error(context.messages, place, "duplicate-id",
            fmt::format("the id '{}' is taken: first defined at {}", escape_text(id),
                        place_text(context.messages, place_of(context.tree, first), place)));
}

// The value of an object's key `id`, or kNone.
uint32_t find_own_id(const Tree& tree, uint32_t object) {
  if (tree.nodes[object].kind != NodeKind::kMap) return kNone;
  for (uint32_t key = tree.nodes[object].first; key != kNone; key = tree.nodes[tree.nodes[key].next].next)
    if (text_of(tree, key) == "id") return tree.nodes[key].next;
  return kNone;
}

}  // namespace

void read_object(const Context& context, uint32_t node, const ObjectName& name, const Inherited& inherited,
                 SceneObjects& scene) {
  if (scene.is_full) return;
  const MapValues map = read_map(context, node, object_keys());
  if (!map.good) return;
  const ShapeRow* shape = find_shape(context, map);
  if (!shape) return;
  Inherited own = inherited;
  if (!read_own(context, map, scene.materials, own)) return;
  Transform transform;
  bool moved = false;
  if (!read_object_transform(context, map, transform, moved)) return;
  const uint32_t id_node = value_of(map, "id").node;
  const std::string id =
      id_node != kNone ? name.prefix + std::string(text_of(context.tree, id_node)) : name.unnamed;
  const uint32_t row = add_object(id_node != kNone ? id_node : node, own, scene.objects);
  const size_t first = scene.outlines.size();
  shape->build({context, map, value_of(map, shape->name).node, id, own, row, scene});
  if (moved) apply_transform(transform, node, first, scene.outlines);
  check_counts(context, node, scene);
}

bool is_id_taken(const Context& context, uint32_t object, const std::string& prefix, IdTable& ids) {
  const Tree& tree = context.tree;
  const uint32_t node = find_own_id(tree, object);
  if (node == kNone || text_of(tree, node).empty()) return false;
  const auto [row, is_new] = ids.try_emplace(prefix + std::string(text_of(tree, node)), node);
  // An alias of an object stands for the same id at another place.
  if (!is_new) report_duplicate_id(context, row->second == node ? object : node, row->first, row->second);
  return !is_new;
}

void read_objects(const Context& context, uint32_t list, SceneObjects& scene) {
  const Tree& tree = context.tree;
  size_t number = 0;
  for (uint32_t child = tree.nodes[list].first; child != kNone; child = tree.nodes[child].next) {
    ++number;
    if (is_id_taken(context, child, context.prefix, scene.ids)) continue;
    const std::string unnamed = fmt::format("{}object{}", context.prefix, number);
    const uint32_t id = find_own_id(tree, child);
    const std::string_view own = id == kNone ? std::string_view{} : text_of(tree, id);
    Inherited inherited;
    inherited.top = static_cast<uint32_t>(scene.objects.top_ids.size());
    scene.objects.top_ids.push_back(own.empty() ? unnamed : context.prefix + std::string(own));
    read_object(context, child, {context.prefix, unnamed}, inherited, scene);
    if (scene.is_full) return;
  }
}

void check_ids(const Context& context, const ObjectTable& objects, const OutlineTable& outlines) {
  std::unordered_map<std::string_view, uint32_t> first;
  first.reserve(outlines.size());
  std::deque<std::string> backs;  // ids of second sides
  uint32_t reported = kNone;      // one message an object, however many parts it has
  const auto check = [&](std::string_view id, uint32_t p) {
    const auto [row, is_new] = first.try_emplace(id, p);
    if (is_new || outlines.object[p] == reported) return;
    reported = outlines.object[p];
    report_duplicate_id(context, objects.node[outlines.object[p]], id,
                        objects.node[outlines.object[row->second]]);
  };
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    check(outlines.id[p], p);
    if (objects.two_sided[outlines.object[p]]) check(backs.emplace_back(outlines.id[p] + ".back"), p);
  }
}

}  // namespace patchlight
