// Settings and their origins: built-in, file, -D and --set, flags.
#include "tools/verbs/show.h"

#include "tools/render/plan.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace patchlight;

namespace {

constexpr std::string_view kScene = R"(patchlight: 1
units: cm
let: {n: 3, m: "=$n+1"}
materials: {glow: {emission: 1}}
objects: [{quad: {size: [1, 1]}, material: glow}]
cameras:
  - {name: near, eye: [0, 2, 3], target: [0, 0, 0], fov: 45}
  - {name: far, eye: [0, 20, 30], target: [0, 0, 0], size: [64, 48]}
solver: {passes: $n, until: 0.25}
output: {snapshots: [1, 2]}
)";

struct Row {
  std::string value, origin;
};

// What `show` says of one setting; empty where it does not name it.
Row find_setting(std::string_view path, const LoadOptions& load, const Options& options,
                 std::string_view text = kScene) {
  std::vector<Diagnostic> warnings;
  Scene scene = load_scene_text(text, "room.yaml", warnings, load);
  make_plan(scene, options);
  const SettingTable settings = merge_flags(scene, options);
  const auto found = std::find(settings.path.begin(), settings.path.end(), path);
  if (found == settings.path.end()) return {};
  const auto row = static_cast<size_t>(found - settings.path.begin());
  return {settings.value[row], settings.origin[row]};
}

}  // namespace

TEST_CASE("every setting says where it comes from") {
  const auto ask = [](std::string_view path, const LoadOptions& load = {}, const Options& options = {}) {
    const Row row = find_setting(path, load, options);
    return row.value + " <- " + row.origin;
  };
  CHECK(ask("units") == "cm <- room.yaml:2:8");
  CHECK(ask("let.m") == "4 <- room.yaml:3:16 (=$n+1)");
  CHECK(ask("solver.passes") == "3 <- room.yaml:9:18 ($n)");
  CHECK(ask("solver.until") == "0.25 <- room.yaml:9:29");
  CHECK(ask("solver.rays") == "144 <- built-in");
  CHECK(ask("solver.patch_size") == "automatic <- built-in");
  CHECK(ask("cameras.near.fov") == "45 <- room.yaml:7:58");
  CHECK(ask("cameras.near.up") == "[0, 1, 0] <- built-in");
  CHECK(ask("cameras.far.size") == "[64, 48] <- room.yaml:8:60");
  CHECK(ask("output.snapshots") == "[1, 2] <- room.yaml:10:21");
  CHECK(ask("output.basename") == "room <- built-in: the scene file's name");

  const LoadOptions load{{"n=5"}, {"solver.rays=64", "output={exposure: -2}"}};
  CHECK(ask("let.n", load) == "5 <- -D n=5");
  CHECK(ask("let.m", load) == "6 <- room.yaml:3:16 (=$n+1)");
  CHECK(ask("solver.passes", load) == "5 <- room.yaml:9:18 ($n)");
  CHECK(ask("solver.rays", load) == "64 <- --set solver.rays");
  CHECK(ask("output.exposure", load) == "-2 <- --set output");
  CHECK(ask("output.snapshots", load) == "[1, 2, 5] <- built-in");

  Options options;
  options.passes = 8;
  options.rays = 16;
  options.snapshots_all = true;
  options.exposure_ev = 1.5;
  options.shading = Shading::kFlat;
  options.size = {32, 24};
  options.camera = "far";
  CHECK(ask("solver.passes", load, options) == "8 <- --passes");
  CHECK(ask("solver.rays", load, options) == "16 <- --rays");
  CHECK(ask("output.snapshots", load, options) == "[1, 2, 3, 4, 5, 6, 7, 8] <- --snapshots");
  CHECK(ask("output.exposure", load, options) == "1.5 <- --exposure");
  CHECK(ask("output.shading", load, options) == "flat <- --shading");
  CHECK(ask("cameras.far.size", load, options) == "[32, 24] <- --size");
  CHECK(find_setting("cameras.near.size", load, options).value.empty());
}

TEST_CASE("a camera that was fitted is shown in the file's units, ready to be copied") {
  const Row eye = find_setting("camera.eye", {}, {}, R"(patchlight: 1
materials: {glow: {emission: 1}}
objects: [{room: {size: [200, 100, 300]}, material: glow}]
)");
  CHECK(eye.origin == "fitted to the scene");
  CHECK(eye.value.starts_with("["));
  // Outside of the room, which is 300 long: beyond it, and not engine lengths, which are about 1.
  CHECK(std::stod(eye.value.substr(eye.value.rfind(',') + 1)) > 300);
}
