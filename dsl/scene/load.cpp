// The door of this folder: text -> tree -> values -> polygons -> faces.
#include "dsl/scene/load.h"

#include "dsl/language/let.h"
#include "dsl/language/overrides.h"
#include "dsl/language/values.h"
#include "dsl/models/materials.h"
#include "dsl/polygons/outlines.h"
#include "dsl/report/limits.h"
#include "dsl/scene/camera_fit.h"
#include "dsl/scene/cameras.h"
#include "dsl/scene/effective.h"
#include "dsl/scene/expect.h"
#include "dsl/scene/faces.h"
#include "dsl/scene/include.h"
#include "dsl/scene/settings.h"
#include "dsl/scene/sky.h"
#include "dsl/scene/suspicious.h"
#include "dsl/shapes/objects.h"
#include "dsl/yaml/source.h"
#include "dsl/yaml/tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace patchlight {
namespace {

// Rows as the choices of `units`.
constexpr std::array<std::string_view, 5> kUnitNames = {"m", "cm", "mm", "ft", "in"};
constexpr std::array<double, 5> kUnitMetres = {1, 0.01, 0.001, 0.3048, 0.0254};

void check_version(const Context& context, const MapValues& map) {
  const Value& version = value_of(map, "patchlight");
  if (version.node == kNone)
    add_error(context.messages, {place_of(context.tree, map.node).file, 1, 1}, "missing-version",
              "the language's version is missing: add 'patchlight: 1' as the first line");
  check_version_known(context, map);
}

// The node of a key, where it is there and of the right kind.
uint32_t node_of(const Tree& tree, const MapValues& map, std::string_view key, NodeKind kind) {
  const uint32_t node = value_of(map, key).node;
  return node != kNone && tree.nodes[node].kind == kind ? node : kNone;
}

// Variables, materials and objects of all files: included ones come first.
void read_contents(Context& context, const std::vector<SceneFile>& files, const LoadOptions& options,
                   VariableTable& variables, SceneObjects& objects) {
  const Tree& tree = context.tree;
  const auto for_files = [&](std::string_view key, NodeKind kind, auto&& read) {
    for (const SceneFile& file : files) {
      const uint32_t node = node_of(tree, file.map, key, kind);
      context.prefix = file.prefix;
      if (node != kNone) read(node);
    }
    context.prefix.clear();
  };
  for_files("let", NodeKind::kMap, [&](uint32_t node) { read_let(context, node, variables); });
  define_variables(context.messages, options.definitions, variables);
  work_out_variables(context, variables);
  for_files("materials", NodeKind::kMap,
            [&](uint32_t node) { read_materials(context, node, objects.materials); });
  for_files("objects", NodeKind::kList, [&](uint32_t node) { read_objects(context, node, objects); });
}

// The maps that only the scene itself has.
void read_settings(const Context& context, const MapValues& map, Scene& scene) {
  const Tree& tree = context.tree;
  check_version(context, map);
  scene.title = has(map, "title") ? text_of(tree, value_of(map, "title").node) : std::string_view{};
  const auto unit = static_cast<size_t>(value_of(map, "units").integer[0]);
  scene.units = kUnitNames[unit];
  scene.metres_per_unit = kUnitMetres[unit];
  read_sky(context, map, scene);
  if (const uint32_t node = node_of(tree, map, "camera", NodeKind::kMap); node != kNone)
    read_camera(context, node, scene.cameras);
  if (const uint32_t node = node_of(tree, map, "cameras", NodeKind::kList); node != kNone)
    read_cameras(context, node, scene.cameras);
  if (const uint32_t node = node_of(tree, map, "solver", NodeKind::kMap); node != kNone)
    read_solver(context, node, scene.solver);
  if (const uint32_t node = node_of(tree, map, "output", NodeKind::kMap); node != kNone)
    read_output(context, node, scene.solver, scene.output);
}

void check_not_empty(const Context& context, const MapValues& map, const SceneObjects& objects) {
  if (objects.outlines.size() > 0 || context.messages.error_count > 0) return;
  const uint32_t list = value_of(map, "objects").node;
  add_error(context.messages, place_of(context.tree, list != kNone ? list : map.node), "empty-scene",
            objects.objects.size() > 0 ? "the scene's objects have no polygons" : "the scene has no objects");
}

void warn_of_materials(const Context& context, const MaterialTable& materials, const Sky& sky,
                       uint32_t root) {
  bool emits = !sky.is_dark();
  for (uint32_t m = 0; m < materials.size(); ++m) {
    const Place place = place_of(context.tree, materials.node[m]);
    if (!materials.used[m])
      add_warning(context.messages, place, "unused-material",
                  fmt::format("no object uses the material '{}'", escape_text(materials.name[m])));
    const DRgb e = materials.emission[m];
    emits = emits || (materials.used[m] && std::max({e.r, e.g, e.b}) > 0);
  }
  if (!emits)
    add_warning(
        context.messages, place_of(context.tree, root), "no-emitter",
        "nothing emits light: every picture will be black; give a material an emission, or add a sky");
}

// Are the three channels of the sky and the sun equal?
bool is_grey(const Sky& sky) {
  const auto is_even = [](Rgb value) { return value.r == value.g && value.g == value.b; };
  return !sky.clear && is_even(sky.zenith) && is_even(sky.horizon) && is_even(sky.ground) &&
         is_even(sky.sun_emission);
}

// File units to engine lengths.
void convert_lengths(Scene& scene) {
  const auto place = [&](DVec3 p) { return (p - scene.origin) / scene.units_per_length; };
  for (Camera& camera : scene.cameras) {
    camera.eye = place(camera.eye);
    camera.target = place(camera.target);
  }
  scene.solver.patch_size = to_patch_size(scene.solver.patch_size / scene.units_per_length);
  scene.solver.patch_size_min = to_patch_size(scene.solver.patch_size_min / scene.units_per_length);
}

Scene compile(Messages& messages, const std::string& path, const LoadOptions& options,
              std::vector<Diagnostic>& warnings) {
  Scene scene;
  scene.file = messages.files[0].name;
  if (!check_source(messages, 0)) throw_errors(messages);
  messages.scene_bytes = messages.files[0].text.size();
  Tree tree;
  const uint32_t root = parse_tree(messages, 0, tree);
  throw_errors(messages);
  if (root == kNone || tree.nodes[root].kind == NodeKind::kNull) {
    add_error(messages, {0, 1, 1}, "empty-scene", "the file holds no scene; it begins with 'patchlight: 1'");
    throw_errors(messages);
  }
  VariableTable variables;
  Context context{tree, messages, &variables};
  if (tree.nodes[root].kind != NodeKind::kMap) {
    add_error(messages, place_of(tree, root), "root-not-map",
              fmt::format("a scene is a map that begins with 'patchlight: 1', got {}", describe(tree, root)));
    throw_errors(messages);
  }
  apply_overrides(messages, options.overrides, root, tree);
  const std::vector<SceneFile> files = read_includes(context, tree, root, path);
  const MapValues& map = files.back().map;
  SceneObjects objects;
  read_contents(context, files, options, variables, objects);
  read_settings(context, map, scene);
  check_not_empty(context, map, objects);
  if (!objects.is_full) {
    check_ids(context, objects.objects, objects.outlines);
    make_faces(messages, tree, objects.materials, objects.objects, objects.outlines,
               std::max(options.limits.starting_patches, scene.solver.patch_count_max), scene,
               options.fine_corners);
  }
  scene.is_heat = scene.is_heat && is_grey(scene.sky);
  throw_errors(messages);
  if (const uint32_t list = value_of(map, "expect").node; list != kNone)
    read_expectations(context, list, scene);
  throw_errors(messages);
  warn_of_materials(context, objects.materials, scene.sky, root);
  warn_of_flipped(messages, tree, objects.materials, objects.objects, objects.outlines);
  warn_of_inside_out_meshes(messages, tree, objects.materials, objects.objects, objects.outlines,
                            scene.cameras);
  convert_lengths(scene);
  if (scene.cameras.empty()) scene.cameras.push_back(fit_camera(scene.faces));
  scene.settings = list_settings(context, map, scene);
  hand_over_warnings(messages, warnings);
  return scene;
}

}  // namespace

Scene load_scene(const std::string& path, std::vector<Diagnostic>& warnings, const LoadOptions& options) {
  Messages messages;
  messages.limits = options.limits;
  messages.files.push_back(
      {path == "-" ? "<stdin>" : path,
       read_bytes(path, options.limits.scene_bytes, limit_text(options.limits, &Limits::scene_bytes))});
  return compile(messages, path == "-" ? "." : path, options, warnings);
}

Scene load_scene_text(std::string_view text, const std::string& name, std::vector<Diagnostic>& warnings,
                      const LoadOptions& options) {
  Messages messages;
  messages.limits = options.limits;
  messages.files.push_back({name, std::string(text)});
  return compile(messages, name, options, warnings);
}

}  // namespace patchlight
