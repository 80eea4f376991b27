// Whole runs: which files, what is in them, what is said.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("render writes pictures after passes 1, 2 and 16 and a report, and ends with their paths") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(render_words(folder / "box.yaml", folder / "lit"));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "box-pass-01.png box-pass-02.png box-pass-16.png box-report.json");
  for (const char* name : {"lit/box-pass-01.png", "lit/box-pass-02.png", "lit/box-pass-16.png"})
    CHECK(is_whole_png(read_bytes(folder / name)));
  CHECK(split_lines(result.out) ==
        std::vector<std::string>{folder / "lit/box-report.json", folder / "lit/box-pass-01.png",
                                 folder / "lit/box-pass-02.png", folder / "lit/box-pass-16.png"});
  for (const char* word : {"passes", "patches", "rays", "seconds", "closure error", "exposure", "files"})
    CHECK_MESSAGE(result.err.find(word) != std::string::npos, word);
}

TEST_CASE("the report of a run has its fields, and power is conserved") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child({"render", folder / "box.yaml", "-o", folder / "lit", "--size",
                                        "48x36", "--max-patches", "4000", "--threads", "2"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
  CHECK(json["polygons"] == 3);
  CHECK(json["faces"] == 3);
  CHECK(json["patches"].get<uint64_t>() >= 16 + 1 + 1);
  CHECK(json["threads"] == 2);
  CHECK(json["rounds"].size() >= 1);
  CHECK(json["passes"].size() == json["stopped"]["pass"].get<size_t>());
  CHECK(json["passes"].size() <= 16);
  // The lamp: 0.36 m2 of 15, 15, 12 W/m2.
  CHECK(json["power"]["emitted"][0].get<double>() == doctest::Approx(5.4));
  CHECK(json["power"]["emitted"][2].get<double>() == doctest::Approx(4.32));
  // The row of a patch has 256 rays: its escaping share has a standard error of at most 1 / 32, and the sum
  // over hundreds of patches a tenth of that or less.
  CHECK(json["power"]["closure_error"].get<double>() < 0.01);
  CHECK(json["power"]["escaped"][0].get<double>() > 0);
  CHECK(json["form_factors"]["row_sum_min"].get<double>() < 1);
  CHECK(json["solution_hash"].get<std::string>().size() == 16);
  CHECK(json["bytes"]["peak"].get<uint64_t>() > 0);
}

TEST_CASE("every format that is asked for is written, and only those") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(render_words(
      folder / "box.yaml", folder / "lit",
      {"--format", "png,exr,csv", "--passes", "2", "--snapshots", "2", "--mesh", "--shading", "flat"}));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(list_names(folder / "lit") ==
        "box-pass-02-flat-mesh.png box-pass-02-flat.exr box-patches.csv box-report.json");
  const std::vector<std::string> rows = split_lines(read_bytes(folder / "lit/box-patches.csv"));
  const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
  CHECK(rows.size() == json["patches"].get<size_t>() + 1);
  CHECK(json["stopped"]["reason"] == "passes");
  CHECK(json["stopped"]["pass"] == 2);
}

TEST_CASE("meshes and the page have the exposure of the pictures, and the same bytes with 1 and 3 threads") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  REQUIRE(run_child(render_words(folder / "box.yaml", folder / "png")).exit_code == 0);
  for (const char* threads : {"1", "3"}) {
    const ChildResult result = run_child(render_words(
        folder / "box.yaml", folder / threads, {"--format", "glb,ply,obj,html", "--threads", threads}));
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    CHECK(list_names(folder / threads) == "box-report.json box.glb box.html box.obj box.ply");
    const auto exposure = [&](const char* run) {
      return Json::parse(read_bytes(folder / run + "/box-report.json"))["exposure"].get<double>();
    };
    CHECK(exposure(threads) == exposure("png"));
  }
  for (const char* name : {"/box.glb", "/box.ply", "/box.obj", "/box.html"})
    CHECK_MESSAGE((read_bytes(folder / "1" + name) == read_bytes(folder / "3" + name)), name);
}

TEST_CASE("a run that converges early writes every asked picture from its last pass") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(
      render_words(folder / "box.yaml", folder / "lit", {"--passes", "500", "--snapshots", "1,499,500"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
  CHECK(json["stopped"]["reason"] == "converged");
  CHECK(json["stopped"]["pass"].get<int>() < 100);
  CHECK(read_bytes(folder / "lit/box-pass-499.png") == read_bytes(folder / "lit/box-pass-500.png"));
  CHECK(read_bytes(folder / "lit/box-pass-01.png") != read_bytes(folder / "lit/box-pass-500.png"));
}

TEST_CASE("a run that does not converge says so") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result =
      run_child(render_words(folder / "box.yaml", folder / "lit", {"--passes", "1", "--format", "csv"}));
  CHECK(result.exit_code == 0);
  CHECK(result.err.find("warning[not-converged]") != std::string::npos);
}

TEST_CASE("the exposure that auto prints repeats its pictures") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  REQUIRE(run_child(render_words(folder / "box.yaml", folder / "a")).exit_code == 0);
  const double ev = Json::parse(read_bytes(folder / "a/box-report.json"))["exposure"];
  REQUIRE(
      run_child(render_words(folder / "box.yaml", folder / "b", {"--exposure", Json(ev).dump()})).exit_code ==
      0);
  CHECK(read_bytes(folder / "a/box-pass-16.png") == read_bytes(folder / "b/box-pass-16.png"));
}

TEST_CASE("the same scene gives the same bytes with 1, 2, 3 and 8 threads, in any locale") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  std::string hash, picture, table;
  for (const char* threads : {"1", "2", "3", "8"}) {
    const std::string out = folder / threads;
    ChildSettings settings;
    settings.environment = {{"LC_ALL", "de_DE.UTF-8"}};
    const ChildResult result = run_child(
        render_words(folder / "box.yaml", out, {"--threads", threads, "--format", "png,csv"}), settings);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    const std::string new_hash = Json::parse(read_bytes(out + "/box-report.json"))["solution_hash"];
    const std::string new_picture = read_bytes(out + "/box-pass-16.png");
    const std::string new_table = read_bytes(out + "/box-patches.csv");
    if (hash.empty()) {
      hash = new_hash;
      picture = new_picture;
      table = new_table;
    }
    CHECK(new_hash == hash);
    CHECK((new_picture == picture));
    CHECK((new_table == table));
  }
}

TEST_CASE("a scene from standard input is called scene") {
  const Folder folder;
  ChildSettings settings;
  settings.input = kBoxScene;
  const ChildResult result =
      run_child(render_words("-", folder / "lit", {"--passes", "1", "--format", "csv"}), settings);
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "scene-patches.csv scene-report.json");
}

TEST_CASE("a basename is taken literally") {
  const Folder folder;
  write_bytes(folder / "box.yaml", std::string(kBoxScene) + "output: {basename: '%s%n%s'}\n");
  const ChildResult result =
      run_child(render_words(folder / "box.yaml", folder / "lit", {"--passes", "1", "--format", "csv"}));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "%s%n%s-patches.csv %s%n%s-report.json");
}

TEST_CASE("with several cameras each has its pictures, or one is picked") {
  const Folder folder;
  write_bytes(folder / "box.yaml", std::string(kBoxScene) +
                                       "cameras:\n"
                                       "  - {name: low, eye: [0.5,0.2,3], target: [0.5,0.5,0]}\n"
                                       "  - {name: high, eye: [0.5,0.9,3], target: [0.5,0.5,0]}\n");
  REQUIRE(run_child(render_words(folder / "box.yaml", folder / "a", {"--passes", "1"})).exit_code == 0);
  CHECK(list_names(folder / "a") == "box-high-pass-01.png box-low-pass-01.png box-report.json");
  REQUIRE(run_child(render_words(folder / "box.yaml", folder / "b", {"--passes", "1", "--camera", "low"}))
              .exit_code == 0);
  CHECK(list_names(folder / "b") == "box-low-pass-01.png box-report.json");
}

TEST_CASE("--report puts the report elsewhere") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result =
      run_child(render_words(folder / "box.yaml", folder / "lit",
                             {"--passes", "1", "--format", "csv", "--report", folder / "r.json"}));
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "box-patches.csv");
  CHECK(Json::parse(read_bytes(folder / "r.json"))["polygons"] == 3);
}

TEST_CASE("check counts a scene and writes nothing") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child({"check", folder / "box.yaml"});
  INFO(result.err);
  CHECK(result.exit_code == 0);
  for (const char* word :
       {"polygons          3", "faces             3", "starting patches", "memory", "camera"})
    CHECK_MESSAGE(result.out.find(word) != std::string::npos, word);
  CHECK(list_names(folder.path) == "box.yaml");
}

TEST_CASE("--quiet leaves the paths only") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(
      render_words(folder / "box.yaml", folder / "lit", {"--passes", "40", "--format", "csv", "--quiet"}));
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK(split_lines(result.out).size() == 2);
}

TEST_CASE("--version and --help answer on standard output") {
  const ChildResult version = run_child({"--version"});
  CHECK(version.exit_code == 0);
  for (const char* word : {"patchlight", "Embree", "oneTBB", "threads"})
    CHECK_MESSAGE(version.out.find(word) != std::string::npos, word);
  const ChildResult help = run_child({"render", "--help"});
  CHECK(help.exit_code == 0);
  CHECK(help.out.find("Examples:") != std::string::npos);
  CHECK(help.err.empty());
}

TEST_CASE("what is legal and dark is told with its reason") {
  const Folder folder;
  const auto said = [&](const std::string& scene) {
    write_bytes(folder / "dark.yaml", scene);
    const ChildResult result = run_child(render_words(folder / "dark.yaml", folder / "lit"));
    CHECK(result.exit_code == 0);
    std::string slugs;
    for (const std::string& line : split_lines(result.err))
      for (const char* slug : {"nothing-lit", "lost-lamp", "empty-view"})
        if (line.find(std::string("warning[") + slug + "]") != std::string::npos)
          slugs += std::string(slug) + " ";
    return slugs;
  };
  const std::string box = kBoxScene;
  const auto replaced = [&](std::string scene, const std::string& from, const std::string& to) {
    scene.replace(scene.find(from), from.size(), to);
    return scene;
  };
  CHECK(said(box) == "");
  const std::string up = "[[0.2,1,0.8],[0.8,1,0.8],[0.8,1,0.2],[0.2,1,0.2]]";
  const std::string down = "[[0.2,1,0.2],[0.8,1,0.2],[0.8,1,0.8],[0.2,1,0.8]]";
  CHECK(said(replaced(box, down, up)) == "nothing-lit ");
  CHECK(said(replaced(box, "[0.73, 0.73, 0.73]", "0")) == "nothing-lit ");
  CHECK(said(box + "  - {id: lost, polygon: [[3,1,1],[4,1,1],[4,1,0],[3,1,0]], material: lamp}\n") ==
        "lost-lamp ");
  // Of a box that shines, one side is enough.
  CHECK(said(box + "  - {box: {at: [0.4, 0.4, 0.4], size: [0.1, 0.1, 0.1]}, material: lamp}\n") == "");
  CHECK(said(box + "camera: {eye: [0.5, 0.5, 3], target: [0.5, 0.5, 9]}\n") == "empty-view ");
}
