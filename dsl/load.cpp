// The door of this folder: text -> tree -> values -> polygons -> faces.
#include "load.h"

#include "camera_fit.h"
#include "faces.h"
#include "limits.h"
#include "materials.h"
#include "objects.h"
#include "outlines.h"
#include "settings.h"
#include "source.h"
#include "tree.h"
#include "values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace patchlight {
namespace {

// Rows as the choices of `units`.
constexpr std::array<std::string_view, 5> kUnitNames = {"m", "cm", "mm", "ft", "in"};
constexpr std::array<double, 5> kUnitMetres = {1, 0.01, 0.001, 0.3048, 0.0254};

// What the file says, before it becomes faces.
struct SceneText {
  MaterialTable materials;
  ObjectTable objects;
  OutlineTable outlines;
};

void check_version(const Context& context, const MapValues& map) {
  const Value& version = value_of(map, "patchlight");
  if (version.node == kNone)
    add_error(context.messages, {place_of(context.tree, map.node).file, 1, 1}, "missing-version",
              "the language's version is missing: add 'patchlight: 1' as the first line");
  else if (version.integer[0] > 1)
    add_error(context.messages, place_of(context.tree, version.node), "version-too-new",
              fmt::format("version {} of the language is newer than this program, which knows version 1",
                          version.integer[0]));
}

void read_scene(const Context& context, uint32_t root, SceneText& text, Scene& scene) {
  const Tree& tree = context.tree;
  const MapValues map = read_map(context, root, kSceneKeys);
  check_version(context, map);
  const auto node_of = [&](std::string_view key, NodeKind kind) {
    const uint32_t node = value_of(map, key).node;
    return node != kNone && tree.nodes[node].kind == kind ? node : kNone;
  };
  scene.title = has(map, "title") ? text_of(tree, value_of(map, "title").node) : std::string_view{};
  const auto unit = static_cast<size_t>(value_of(map, "units").integer[0]);
  scene.units = kUnitNames[unit];
  scene.metres_per_unit = kUnitMetres[unit];
  if (const uint32_t node = node_of("materials", NodeKind::kMap); node != kNone)
    read_materials(context, node, text.materials);
  if (const uint32_t node = node_of("objects", NodeKind::kList); node != kNone)
    read_objects(context, node, text.materials, text.objects, text.outlines);
  else if (!has(map, "objects") && map.good)
    add_error(context.messages, place_of(tree, root), "empty-scene",
              "the scene has no objects: 'objects' is missing");
  if (has(map, "camera") && has(map, "cameras"))
    add_error(context.messages, place_of(tree, value_of(map, "cameras").node), "ambiguous-shape",
              "a scene has either 'camera' or 'cameras'");
  if (const uint32_t node = node_of("camera", NodeKind::kMap); node != kNone)
    read_camera(context, node, scene.cameras);
  if (const uint32_t node = node_of("cameras", NodeKind::kList); node != kNone)
    read_cameras(context, node, scene.cameras);
  if (const uint32_t node = node_of("solver", NodeKind::kMap); node != kNone)
    read_solver(context, node, scene.solver);
  if (const uint32_t node = node_of("output", NodeKind::kMap); node != kNone)
    read_output(context, node, scene.solver, scene.output);
}

void warn_of_materials(const Context& context, const SceneText& text, uint32_t root) {
  bool emits = false;
  for (uint32_t m = 0; m < text.materials.size(); ++m) {
    const Place place = place_of(context.tree, text.materials.node[m]);
    if (!text.materials.used[m])
      add_warning(context.messages, place, "unused-material",
                  fmt::format("no object uses the material '{}'", escape_text(text.materials.name[m])));
    const DRgb e = text.materials.emission[m];
    emits = emits || (text.materials.used[m] && std::max({e.r, e.g, e.b}) > 0);
  }
  if (!emits)
    add_warning(context.messages, place_of(context.tree, root), "no-emitter",
                "nothing emits light: every picture will be black; give a material an emission");
}

// File units to engine lengths.
void convert_lengths(Scene& scene) {
  const auto place = [&](DVec3 p) { return (p - scene.origin) / scene.units_per_length; };
  for (Camera& camera : scene.cameras) {
    camera.eye = place(camera.eye);
    camera.target = place(camera.target);
  }
  scene.solver.patch_size = static_cast<float>(scene.solver.patch_size / scene.units_per_length);
  scene.solver.patch_size_min = static_cast<float>(scene.solver.patch_size_min / scene.units_per_length);
}

Scene compile(Messages& messages, std::vector<Diagnostic>& warnings) {
  Scene scene;
  scene.file = messages.files[0].name;
  if (!check_source(messages, 0)) throw_errors(messages);
  Tree tree;
  const uint32_t root = parse_tree(messages, 0, tree);
  throw_errors(messages);
  if (root == kNone || tree.nodes[root].kind == NodeKind::kNull) {
    add_error(messages, {0, 1, 1}, "empty-scene", "the file holds no scene; it begins with 'patchlight: 1'");
    throw_errors(messages);
  }
  const Context context{tree, messages};
  if (tree.nodes[root].kind != NodeKind::kMap) {
    add_error(messages, place_of(tree, root), "root-not-map",
              fmt::format("a scene is a map that begins with 'patchlight: 1', got {}", describe(tree, root)));
    throw_errors(messages);
  }
  SceneText text;
  read_scene(context, root, text, scene);
  check_ids(context, text.objects, text.outlines);
  if (messages.error_count == 0 || text.outlines.size() <= kPolygonsMax)
    make_faces(messages, tree, text.materials, text.objects, text.outlines,
               std::max<uint64_t>(kStartPatchesMax, scene.solver.patch_count_max), scene);
  throw_errors(messages);
  warn_of_materials(context, text, root);
  convert_lengths(scene);
  if (scene.cameras.empty()) scene.cameras.push_back(fit_camera(scene.faces));
  hand_over_warnings(messages, warnings);
  return scene;
}

}  // namespace

Scene load_scene(const std::string& path, std::vector<Diagnostic>& warnings) {
  Messages messages;
  messages.files.push_back({path == "-" ? "<stdin>" : path, read_bytes(path)});
  return compile(messages, warnings);
}

Scene load_scene_text(std::string_view text, const std::string& name, std::vector<Diagnostic>& warnings) {
  Messages messages;
  messages.files.push_back({name, std::string(text)});
  return compile(messages, warnings);
}

}  // namespace patchlight
