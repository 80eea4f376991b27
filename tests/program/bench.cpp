// The verb bench on a tiny scene: its keys, and that its figures are numbers; how fast is not asked.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void check_figure(const Json& figure) {
  CAPTURE(figure.dump());
  for (const char* key : {"median", "low", "high"}) {
    CHECK(std::isfinite(figure[key].get<double>()));
    CHECK(figure[key].get<double>() > 0);
  }
  CHECK(figure["low"].get<double>() <= figure["median"].get<double>());
  CHECK(figure["median"].get<double>() <= figure["high"].get<double>());
  CHECK(figure["runs"].get<int>() >= 1);
}

}  // namespace

TEST_CASE("bench prints its sections and writes them as JSON") {
  const Folder folder;
  const std::string camera = "camera: {eye: [2, 2, 2], target: [0, 0, 0], size: [32, 24]}\n";
  write_bytes(folder / "box.yaml", kBoxScene + camera);
  const ChildResult result =
      run_child({"bench", folder / "box.yaml", "--only", "kernels,scenes,loading,growth,threads", "--json",
                 folder / "b.json", "--repetitions", "1", "--seconds", "0.001", "--threads", "2",
                 "--max-patches", "2000"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  for (const char* word : {"kernels, on ", "scenes, whole program", "loading, on one thread", "growth, solve",
                           "threads, solve", "bare traversal of the same rays", "the same bits"})
    CHECK_MESSAGE(has(result.out, word), word);
  CHECK(list_names(folder.path) == "b.json box.yaml");

  const Json json = Json::parse(read_bytes(folder / "b.json"));
  for (const char* key : {"processor", "cores", "memory_bytes", "compiler", "build", "tracer", "tbb", "date"})
    CHECK_MESSAGE(json["machine"].contains(key), key);
  REQUIRE(json["kernels"]["kernels"].size() > 10);
  for (const Json& figure : json["kernels"]["kernels"]) check_figure(figure);
  REQUIRE(json["kernels"]["ratios"].size() >= 4);
  for (const Json& figure : json["kernels"]["ratios"]) check_figure(figure);
  REQUIRE(json["scenes"].size() == 1);
  const Json& scene = json["scenes"][0];
  check_figure(scene["seconds"]["total"]);
  check_figure(scene["rays_per_second"]);
  check_figure(scene["bytes_peak"]);
  CHECK(scene["patches"].get<uint64_t>() <= 2000);
  CHECK(scene["bare_traversal_share"].get<double>() > 0);
  CHECK(scene["visibility_rays"].get<uint64_t>() > 0);
  REQUIRE(json["loading"].size() == 5);
  for (const Json& row : json["loading"]) {
    for (const char* key : {"load_seconds", "pass_seconds", "ratio", "load_bytes_peak"})
      check_figure(row[key]);
    // 2000 polygons and the lamp, 1000 materials, and 166 times 300 wrong numbers.
    const bool is_wrong = row["name"] == "errors";
    CHECK(row["errors"].get<int>() == (is_wrong ? 49'800 : 0));
    CHECK((row["polygons"].get<int>() == 0) == is_wrong);
  }
  CHECK(json["loading"][0]["polygons"] == 2001);
  CHECK(json["loading"][0]["polygons"] == json["loading"][1]["polygons"]);
  REQUIRE(json["growth"]["steps"].size() >= 2);
  for (const Json& step : json["growth"]["steps"]) check_figure(step["wall_seconds"]);
  CHECK(std::isfinite(json["growth"]["tenfold"]["processor_seconds"].get<double>()));
  REQUIRE(json["threads"]["steps"].size() == 2);
  for (const Json& step : json["threads"]["steps"]) check_figure(step["speedup"]);
  CHECK(json["threads"]["same"] == true);
}

TEST_CASE("bench knows a furnace's answer") {
  const Folder folder;
  write_bytes(folder / "furnace.yaml", R"(patchlight: 1
materials: {glow: {reflectance: 0.5, emission: 0.5}}
objects: [{id: room, room: {size: [1, 1, 1]}, material: glow}]
camera: {eye: [0.5, 0.5, 0.9], target: [0.5, 0.5, 0], size: [32, 24]}
solver: {passes: 4, until: 0, max_patches: 2000, rays: 32}
)");
  const ChildResult result = run_child({"bench", folder / "furnace.yaml", "--only", "scenes", "--json",
                                        folder / "b.json", "--repetitions", "1", "--quiet"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const Json row = Json::parse(read_bytes(folder / "b.json"))["scenes"][0];
  CHECK(row["passes"] == 4);
  // Sums of some thousand floats.
  CHECK(row["error"].get<double>() < 1e-4);
}

TEST_CASE("bench refuses what it cannot measure before it measures") {
  const Folder folder;
  write_bytes(folder / "wrong.yaml", "patchlight: 1\nobjects: 3\n");
  write_bytes(folder / "box.yaml", kBoxScene);
  CHECK(run_child({"bench", "--only", "speed"}).exit_code == 2);
  CHECK(run_child({"bench", folder / "wrong.yaml"}).exit_code == 3);
  const ChildResult missing = run_child({"bench", "nope.yaml"});
  CHECK(missing.exit_code == 4);
  CHECK(missing.out.empty());
  CHECK(run_child({"bench", folder / "box.yaml", "--json", folder / "no/b.json"}).exit_code == 4);
  const ChildResult patches =
      run_child({"bench", folder / "box.yaml", "--only", "kernels", "--max-patches", "3"});
  CHECK(patches.exit_code == 5);
  CHECK(has(patches.err, "error[too-many-patches]"));
}

TEST_CASE("bench that is stopped by a signal leaves nothing behind") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Folder folder, temporary;
    write_bytes(folder / "box.yaml",
                std::string(kBoxScene) + "solver: {until: 0, passes: 10000, max_patches: 50000}\n");
    Child child;
    ChildSettings settings;
    settings.environment = {{"TMPDIR", temporary.path}};
    start_child(child, {"bench", folder / "box.yaml", "--only", "scenes", "--json", folder / "b.json"},
                settings);
    for (int k = 0; k < 3000 && list_names(temporary.path).empty(); ++k) usleep(10000);
    CHECK(list_names(temporary.path).starts_with("patchlight-bench-"));
    kill(child.process, signal);
    const ChildResult result = finish_child(child);
    INFO(result.err);
    CHECK(result.exit_code == 128 + signal);
    CHECK(list_names(temporary.path).empty());
    CHECK(list_names(folder.path) == "box.yaml");
  }
}
