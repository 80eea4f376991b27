// Whole runs: the pictures that flags ask for, and what is in them.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>
#include <tinyexr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

// R, G, B of every pixel.
std::vector<float> read_exr(const std::string& path) {
  const std::string file = read_bytes(path);
  float* pixels = nullptr;
  int width = 0, height = 0;
  const char* error = nullptr;
  REQUIRE(LoadEXRFromMemory(&pixels, &width, &height, reinterpret_cast<const unsigned char*>(file.data()),
                            file.size(), &error) == TINYEXR_SUCCESS);
  std::vector<float> values;
  for (int k = 0; k < width * height; ++k) values.insert(values.end(), pixels + 4 * k, pixels + 4 * k + 3);
  std::free(pixels);
  return values;
}

// A GIF has a graphic control extension a frame.
size_t count_frames(const std::string& path) {
  const std::string bytes = read_bytes(path), mark("\x21\xf9\x04", 3);
  size_t count = 0;
  for (size_t at = bytes.find(mark); at != std::string::npos; at = bytes.find(mark, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("pictures of direct and of indirect light add up to those of all light") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  for (const char* light : {"all", "direct", "indirect"}) {
    const ChildResult result = run_child(render_words(
        folder / "box.yaml", folder / "lit", {"--light", light, "--format", "exr", "--snapshots", "1,16"}));
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
  }
  for (const char* pass : {"01", "16"}) {
    const std::string stem = folder / "lit/box-pass-" + pass;
    const std::vector<float> all = read_exr(stem + ".exr"), direct = read_exr(stem + "-direct.exr"),
                             indirect = read_exr(stem + "-indirect.exr");
    double direct_sum = 0, indirect_sum = 0;
    for (size_t k = 0; k < all.size(); ++k) {
      // Sums of at most 256 samples, each rounded.
      CHECK(std::abs(direct[k] + indirect[k] - all[k]) <= 2e-5f * all[k]);
      CHECK(indirect[k] >= 0);
      direct_sum += direct[k];
      indirect_sum += indirect[k];
    }
    CHECK(direct_sum > 0);
    CHECK((indirect_sum > 0) == (std::string(pass) == "16"));
  }
}

TEST_CASE("render shows what a camera's projection shows: straight edges, or a hemisphere in a circle") {
  const Folder folder;
  const char* const cameras = R"(cameras:
  - {name: flat, eye: [0.5, 0.5, 0.9], target: [0.5, 0.5, 0]}
  - {name: round, eye: [0.5, 0.5, 0.9], target: [0.5, 0.5, 0], projection: fisheye}
)";
  write_bytes(folder / "box.yaml", kBoxScene + std::string(cameras));
  const ChildResult result = run_child(
      render_words(folder / "box.yaml", folder / "lit", {"--format", "exr,png", "--snapshots", "1"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const std::vector<float> flat = read_exr(folder / "lit/box-flat-pass-01.exr"),
                           round = read_exr(folder / "lit/box-round-pass-01.exr");
  // In the middle both look at the wall. The circle is 36 of the 48 pixels wide.
  const auto pixel = [](size_t x, size_t y) { return 3 * (48 * y + x); };
  CHECK(flat[pixel(24, 18)] > 0);
  CHECK(round[pixel(24, 18)] == doctest::Approx(flat[pixel(24, 18)]).epsilon(0.05));
  for (const size_t x : {size_t{0}, size_t{5}, size_t{42}, size_t{47}}) CHECK(round[pixel(x, 18)] == 0);
  // A hemisphere holds the lamp, which 60 degrees do not.
  CHECK(*std::max_element(round.begin(), round.end()) > *std::max_element(flat.begin(), flat.end()));
  CHECK(is_whole_png(read_bytes(folder / "lit/box-round-pass-01.png")));
}

TEST_CASE("looks are named in the files, and differ") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  std::vector<std::string> pictures;
  const std::vector<std::pair<std::vector<std::string>, std::string>> looks = {
      {{}, ""},
      {{"--tone", "filmic"}, "-filmic"},
      {{"--false-color", "radiosity"}, "-radiosity"},
      {{"--false-color", "radiosity", "--light", "direct", "--scale", "linear"}, "-direct-radiosity"},
      {{"--false-color", "residual"}, "-residual"},
      {{"--false-color", "level"}, "-level"},
      {{"--false-color", "reason", "--mesh"}, "-reason-mesh"},
  };
  for (const auto& [flags, suffix] : looks) {
    const ChildResult result = run_child(render_words(folder / "box.yaml", folder / "lit", flags));
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    CHECK(result.err.find("bad-radiosity") == std::string::npos);
    const std::string picture = read_bytes(folder / ("lit/box-pass-16" + suffix + ".png"));
    CHECK(is_whole_png(picture));
    for (const std::string& other : pictures) CHECK(picture != other);
    pictures.push_back(picture);
  }
}

TEST_CASE("a storyboard and animations are written beside the pictures") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result =
      run_child(render_words(folder / "box.yaml", folder / "lit",
                             {"--storyboard", "--animation", "passes,rounds", "--format", "csv"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(list_names(folder / "lit") ==
        "box-passes.gif box-patches.csv box-report.json box-rounds.gif box-storyboard.png");
  CHECK(is_whole_png(read_bytes(folder / "lit/box-storyboard.png")));
  const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
  CHECK(count_frames(folder / "lit/box-passes.gif") == json["passes"].size());
  CHECK(count_frames(folder / "lit/box-rounds.gif") == json["rounds"].size());
}

TEST_CASE("shots are animated one by one") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(
      render_words(folder / "box.yaml", folder / "lit",
                   {"--solver", "shooting", "--shots", "1-4,8", "--animation", "shots", "--format", "csv"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "box-patches.csv box-report.json box-shots.gif");
  CHECK(count_frames(folder / "lit/box-shots.gif") == 5);
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--animation", "shots"},
                                                {"--animation", "shots", "--solver", "shooting"},
                                                {"--solver", "shooting", "--shots", "4-1"}}) {
    const ChildResult wrong = run_child(render_words(folder / "box.yaml", folder / "lit", flags));
    CHECK(wrong.exit_code == 2);
    CHECK_MESSAGE(wrong.err.find("error[usage]: --") != std::string::npos, wrong.err);
  }
}

TEST_CASE("looks of single passes are refused with other solvers, which have storyboards all the same") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  for (const std::vector<std::string>& flags : std::vector<std::vector<std::string>>{
           {"--light", "direct"}, {"--false-color", "residual"}, {"--animation", "passes"}}) {
    std::vector<std::string> words = flags;
    words.insert(words.end(), {"--solver", "shooting"});
    const ChildResult result = run_child(render_words(folder / "box.yaml", folder / "lit", words));
    CHECK(result.exit_code == 2);
    CHECK(result.err.find(flags[0]) != std::string::npos);
  }
  // Few patches: a matrix has all pairs of them.
  const std::vector<std::string> few = {"render", folder / "box.yaml", "--size", "48x36",        "--rays",
                                        "32",     "--max-patches",     "300",    "--storyboard", "--format",
                                        "exr"};
  for (const auto& [flags, name] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--solver", "shooting", "--shots", "3"}, "box-shot-000003.exr"},
           {{"--solver", "matrix"}, "box-solution.exr"}}) {
    std::vector<std::string> words = few;
    words.insert(words.end(), flags.begin(), flags.end());
    words.insert(words.end(), {"-o", folder / name});
    const ChildResult result = run_child(words);
    INFO(result.err);
    CHECK(result.exit_code == 0);
    CHECK(is_whole_png(read_bytes(folder / name + "/box-storyboard.png")));
    const std::string file = read_bytes(folder / name + "/" + name);
    CHECK(file.find(std::string("Z") + '\0') != std::string::npos);
    CHECK(file.find("direct.R") == std::string::npos);
  }
}

TEST_CASE("every layer of an EXR and an HDR are written in one run") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(
      render_words(folder / "box.yaml", folder / "lit", {"--format", "exr,hdr,csv", "--snapshots", "2"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "box-pass-02.exr box-pass-02.hdr box-patches.csv box-report.json");
  const std::string file = read_bytes(folder / "lit/box-pass-02.exr");
  for (const char* name :
       {"direct.R", "direct.G", "direct.B", "indirect.R", "indirect.G", "indirect.B", "id", "Z"})
    CHECK(file.find(std::string(name) + '\0') != std::string::npos);
}

TEST_CASE("plots are written where they are asked for") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result =
      run_child(render_words(folder / "box.yaml", folder / "lit", {"--format", "svg"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "box-convergence.svg box-report.json box-rounds.svg");
  CHECK(read_bytes(folder / "lit/box-convergence.svg").ends_with("</svg>\n"));
}

TEST_CASE("view shows what a patch sees before and after direct light, and says what it cannot see from") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const auto look = [&](const std::string& from, const std::string& pass) {
    return run_child({"view", folder / "box.yaml", "-o", folder / "lit", "--from", from, "--pass", pass,
                      "--size", "64", "--max-patches", "4000"});
  };
  CHECK(look("floor@0.5,0.5", "0").exit_code == 0);
  const ChildResult result = look("floor@0.5,0.5", "1");
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.out == (folder / "lit/box-view-floor@0.5,0.5-pass-01.png") + "\n");
  CHECK(list_names(folder / "lit") ==
        "box-view-floor@0.5,0.5-pass-00.png box-view-floor@0.5,0.5-pass-01.png");
  CHECK(read_bytes(folder / "lit/box-view-floor@0.5,0.5-pass-00.png") !=
        read_bytes(folder / "lit/box-view-floor@0.5,0.5-pass-01.png"));
  const ChildResult unknown = look("flor@0.5,0.5", "1");
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.err.find("did you mean 'floor'?") != std::string::npos);
  CHECK(look("floor@0.5,0.5", "99").exit_code == 3);
}
