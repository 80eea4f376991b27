// Loads damaged scenes and looks at the answer.
#include "support.h"

#include "tests/folder.h"
#include "tools/render/plan.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace patchlight::testing {
namespace {

// Every damaged text is loaded, so that all scenes would make a test of minutes. These, of the shipped ones,
// have every construct that any of them has: includes with prefixes, variables and expressions, aliases,
// holes, repeats by step and by transform, groups, meshes with materials, several cameras, expectations.
constexpr const char* kShippedScenes[] = {"chapel", "cornell_box", "furnace",    "furniture",
                                          "hall",   "l_room",      "model_room", "pillar_room",
                                          "stairs", "view_factors"};

// A slip of a zero shall not make a test of minutes.
Options small_options() {
  Options options;
  options.load.limits.polygons = 20'000;
  options.load.limits.values = 200'000;
  return options;
}

void check_message(const Diagnostic& message) {
  CHECK(!message.slug.empty());
  CHECK(message.slug.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos);
  CHECK(!message.message.empty());
  CHECK(message.line >= 0);
  CHECK((message.line == 0) == (message.column == 0));
  const std::string printed = format_diagnostic(message);
  CHECK(std::none_of(printed.begin(), printed.end(), [](char c) {
    const auto byte = static_cast<uint8_t>(c);
    return (byte < 0x20 && c != '\n') || byte == 0x7f;
  }));
}

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_loaded(const Scene& scene) {
  CHECK(scene.faces.size() > 0);
  CHECK(scene.polygons.face_first.back() == scene.faces.size());
  CHECK(!scene.cameras.empty());
  bool finite = std::isfinite(scene.units_per_length) && scene.units_per_length > 0;
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    for (const Vec3& corner : scene.faces.corners[f]) finite = finite && is_finite(corner);
    finite = finite && is_finite(scene.faces.normal[f]);
  }
  CHECK(finite);
}

}  // namespace

std::vector<SceneText> list_scenes() {
  std::vector<SceneText> scenes;
  const std::string root = PATCHLIGHT_SOURCE_DIR;
  const auto add = [&](const std::string& path) { scenes.push_back({path, read_bytes(path)}); };
  for (const char* name : kShippedScenes) add(root + "/scenes/" + name + ".yaml");
  for (const auto& entry : std::filesystem::directory_iterator(root + "/tests/schema/right"))
    if (entry.path().extension() == ".yaml") add(entry.path().string());
  std::sort(scenes.begin(), scenes.end(),
            [](const SceneText& a, const SceneText& b) { return a.path < b.path; });
  REQUIRE(scenes.size() >= 13);
  return scenes;
}

void check_text(const SceneText& scene, const std::string& text, ExitCounts& counts) {
  static const Options options = small_options();
  std::vector<Diagnostic> warnings;
  int code = 0;
  INFO(text);
  try {
    Scene loaded = load_scene_text(text, scene.path, warnings, options.load);
    check_loaded(loaded);
    const Plan plan = make_plan(loaded, options);
    check_limits(loaded, plan);
  } catch (const UserError& error) {
    REQUIRE(!error.diagnostics.empty());
    for (const Diagnostic& message : error.diagnostics) check_message(message);
    code = exit_code(error.diagnostics.front());
    CHECK(code >= 2);
    CHECK(code <= 5);
  } catch (const std::exception& error) {
    FAIL(error.what());
  }
  for (const Diagnostic& message : warnings) check_message(message);
  ++counts[code];
}

}  // namespace patchlight::testing
