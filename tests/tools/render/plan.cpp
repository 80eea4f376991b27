// What a run will do, from scene and flags.
#include "tools/render/plan.h"

#include "dsl/report/diagnostics.h"
#include "tests/tools/mistakes.h"
#include "tools/image/false_colors.h"
#include "tools/image/tone.h"

#include <doctest/doctest.h>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

Scene make_scene() {
  Scene scene;
  scene.file = "rooms/room.yaml";
  scene.cameras.push_back(Camera{});
  return scene;
}

}  // namespace

TEST_CASE("snapshots are 1, 2, 16 unless named, and none is later than the last pass") {
  using Passes = std::vector<uint32_t>;
  CHECK(pick_snapshots({}, false, 16) == Passes{1, 2, 16});
  CHECK(pick_snapshots({}, false, 40) == Passes{1, 2, 16});
  CHECK(pick_snapshots({}, false, 8) == Passes{1, 2, 8});
  CHECK(pick_snapshots({}, false, 2) == Passes{1, 2});
  CHECK(pick_snapshots({}, false, 1) == Passes{1});
  CHECK(pick_snapshots({3, 5}, false, 5) == Passes{3, 5});
  CHECK(pick_snapshots({}, true, 3) == Passes{1, 2, 3});
}

TEST_CASE("a named snapshot beyond the passes is an error") {
  CHECK(find_slug([] { pick_snapshots({1, 6}, false, 5); }) == "snapshot-beyond-passes");
}

TEST_CASE("files are named after the scene") {
  CHECK(pick_stem("rooms/room.yaml", "") == "room");
  CHECK(pick_stem("room.yml", "") == "room");
  CHECK(pick_stem("room.v2.yaml", "") == "room.v2");
  CHECK(pick_stem("room", "") == "room");
  CHECK(pick_stem(".yaml", "") == ".yaml");
  CHECK(pick_stem("<stdin>", "") == "scene");
  CHECK(pick_stem("rooms/room.yaml", "%s%n") == "%s%n");
}

TEST_CASE("names of pictures say pass, camera, shading and mesh") {
  Scene scene = make_scene();
  Options options;
  Plan plan = make_plan(scene, options);
  const Exporter& png = find_exporter("png");
  const Exporter& exr = find_exporter("exr");
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 1, png) == "room-pass-01.png");
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 1234, exr) == "room-pass-1234.exr");

  scene.cameras = {Camera{}, Camera{}};
  scene.cameras[0].name = "door";
  scene.cameras[1].name = "window";
  options.camera = "window";
  options.mesh = true;
  options.shading = Shading::kFlat;
  plan = make_plan(scene, options);
  REQUIRE(plan.cameras.size() == 1);
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 16, png) == "room-window-pass-16-flat-mesh.png");
  // An EXR holds numbers: no lines are drawn into it.
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 16, exr) == "room-window-pass-16-flat.exr");
  options.look.light = Light::kIndirect;
  plan = make_plan(scene, options);
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 2, png) ==
        "room-window-pass-02-indirect-flat-mesh.png");
  options.look.tone = find_tone("filmic");
  plan = make_plan(scene, options);
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 2, png) ==
        "room-window-pass-02-indirect-filmic-flat-mesh.png");
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 2, exr) == "room-window-pass-02-indirect-flat.exr");
  options.look.false_color = find_false_color("radiosity");
  plan = make_plan(scene, options);
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 2, png) ==
        "room-window-pass-02-indirect-radiosity-flat-mesh.png");
  // Levels do not depend on light or shading.
  options.look.false_color = find_false_color("level");
  plan = make_plan(scene, options);
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 2, png) == "room-window-pass-02-level-mesh.png");
  CHECK(make_picture_name(plan, scene, plan.cameras[0], 2, exr) == "room-window-pass-02-indirect-flat.exr");
}

TEST_CASE("flags are stronger than the scene") {
  Scene scene = make_scene();
  scene.solver.pass_count_max = 4;
  scene.solver.rays = 10;
  scene.output.snapshots = {1, 4};
  scene.output.exposure_ev = 2;
  Options options;
  options.passes = 9;
  options.snapshots = {9};
  options.exposure_auto = true;
  options.size = {{32, 24}};
  const Plan plan = make_plan(scene, options);
  CHECK(scene.solver.pass_count_max == 9);
  CHECK(scene.solver.rays == 10);
  CHECK(plan.snapshots == std::vector<uint32_t>{9});
  CHECK(!scene.output.exposure_ev);
  CHECK(plan.cameras[0].width == 32);
  CHECK(plan.cameras[0].height == 24);
}

TEST_CASE("a camera that is not there is a usage error") {
  Scene scene = make_scene();
  Options options;
  options.camera = "door";
  CHECK(find_slug([&] { make_plan(scene, options); }) == "usage");
}

TEST_CASE("names of files stay in their folder") {
  Scene scene = make_scene();
  scene.output.basename = "../evil";
  CHECK(find_slug([&] { make_plan(scene, Options{}); }) == "output-outside-dir");
}

TEST_CASE("pictures have limits: a side and all pixels") {
  Scene scene = make_scene();
  Options options;
  for (const std::array<uint32_t, 2> size : {std::array<uint32_t, 2>{16385, 1}, {1, 16385}, {16384, 16384}}) {
    options.size = size;
    const Plan plan = make_plan(scene, options);
    CHECK(find_slug([&] { check_limits(scene, plan); }) == "image-too-large");
  }
  options.size = {{20'000, 1}};
  options.load.limits.image_side = 20'000;
  check_limits(scene, make_plan(scene, options));
}

TEST_CASE("memory and time are held to their limits at the border, and the flags that raise them are named") {
  Scene scene = make_scene();
  Options options;
  options.max_memory = forecast_run(scene, make_plan(scene, options)).bytes_most;
  options.max_seconds = forecast_run(scene, make_plan(scene, options)).seconds;
  check_limits(scene, make_plan(scene, options));
  const auto find_mistake = [&] {
    try {
      options.keep_rows = true;
      check_limits(scene, make_plan(scene, options));
    } catch (const UserError& error) {
      CHECK(exit_code(error.diagnostics.front()) == 5);
      return error.diagnostics.front().slug + ": " + error.diagnostics.front().message;
    }
    return std::string{};
  };
  --*options.max_memory;
  CHECK(find_mistake().starts_with("memory-limit: "));
  CHECK(find_mistake().find("--max-memory") != std::string::npos);
  options.max_memory.reset();
  CHECK(find_mistake().empty());
  options.max_seconds *= 0.99;
  CHECK(find_mistake().starts_with("time-limit: "));
  CHECK(find_mistake().find("--max-seconds raises it") != std::string::npos);
}

TEST_CASE("more pixels, cameras and snapshots take longer, more threads less long") {
  Scene scene = make_scene();
  Options options;
  options.threads = 1;
  const RunForecast usual = forecast_run(scene, make_plan(scene, options));
  CHECK(usual.bytes < usual.bytes_most);
  options.threads = 2;
  CHECK(forecast_run(scene, make_plan(scene, options)).seconds < 0.6 * usual.seconds);
  options.threads = 1;
  options.formats = {"csv"};
  CHECK(forecast_run(scene, make_plan(scene, options)).seconds < usual.seconds);
  options.formats = {"png"};
  options.snapshots_all = true;
  CHECK(forecast_run(scene, make_plan(scene, options)).seconds > usual.seconds);
  options.snapshots_all = false;
  scene.cameras.resize(2);
  const RunForecast two = forecast_run(scene, make_plan(scene, options));
  CHECK(two.seconds > usual.seconds);
  CHECK(two.bytes > usual.bytes);
  options.size = {{1920, 1440}};
  CHECK(forecast_run(scene, make_plan(scene, options)).seconds > two.seconds);
}

TEST_CASE("form factors are kept where memory allows, or as the flag says") {
  Scene scene = make_scene();
  Options options;
  make_plan(scene, options);
  CHECK(scene.solver.keep_rows);
  // Rows of a million rays for 24,000 patches: 192 GB.
  options.rays = 1'000'000;
  make_plan(scene, options);
  CHECK(!scene.solver.keep_rows);
  options.keep_rows = true;
  const Plan plan = make_plan(scene, options);
  CHECK(scene.solver.keep_rows);
  CHECK(find_slug([&] { check_limits(scene, plan); }) == "memory-limit");
  options.rays = 16;
  options.keep_rows = false;
  make_plan(scene, options);
  CHECK(!scene.solver.keep_rows);
}

TEST_CASE("what is kept for pictures of several passes counts as memory") {
  Scene scene = make_scene();
  Options options;
  uint64_t before = forecast_run(scene, make_plan(scene, options)).bytes_most;
  const auto check_more = [&](uint64_t least) {
    const uint64_t now = forecast_run(scene, make_plan(scene, options)).bytes_most;
    CHECK(now >= before + least);
    before = now;
  };
  options.animate_passes = true;
  check_more(uint64_t{scene.solver.pass_count_max} * 960 * 720 * 3);
  options.animate_rounds = true;
  check_more(10 * 960 * 720 * 3);
  options.storyboard = true;
  check_more(scene.solver.patch_count_max * sizeof(Rgb));
  options.look.light = Light::kDirect;
  check_more(scene.solver.patch_count_max * sizeof(Rgb));
  options.look.false_color = find_false_color("residual");
  check_more(scene.solver.patch_count_max * sizeof(Rgb));
  options.formats = {"exr"};
  check_more(960 * 720 * 11 * sizeof(float));
}

TEST_CASE("cameras are looked through for pictures, and for meshes and pages where no exposure is given") {
  Scene scene = make_scene();
  Options options;
  const auto films = [&](std::vector<std::string> formats) {
    options.formats = std::move(formats);
    return makes_films(make_plan(scene, options), scene);
  };
  CHECK(films({"png"}));
  CHECK(films({"exr", "html"}));
  CHECK(films({"html"}));
  CHECK(films({"glb"}));
  CHECK(!films({"csv"}));
  options.exposure_ev = 2;
  CHECK(films({"png"}));
  CHECK(!films({"html"}));
  CHECK(!films({"glb", "ply", "obj"}));
}

TEST_CASE("what a mesh or a page takes in memory is forecast") {
  Scene scene = make_scene();
  Options options;
  const auto bytes = [&](std::vector<std::string> formats) {
    options.formats = std::move(formats);
    return forecast_run(scene, make_plan(scene, options)).bytes_most;
  };
  options.exposure_ev = 0;
  const uint64_t patches = scene.solver.patch_count_max;
  CHECK(bytes({"html"}) == bytes({"csv"}) + find_exporter("html").bytes_per_patch * patches);
  // They are written one after the other.
  CHECK(bytes({"html", "glb"}) == bytes({"html"}));
}
