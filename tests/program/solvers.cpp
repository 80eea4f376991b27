// The flag --solver: which files, what the report tells, what is refused.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

// A render whose budget of patches the case says itself.
std::vector<std::string> words(const Folder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"render", folder / "box.yaml", "-o", folder / "lit", "--size", "48x36"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("the matrix writes its solution, once, and the report says how it came about") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(words(folder, {"--solver", "matrix", "--max-patches", "200"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "box-report.json box-solution.png");
  CHECK(is_whole_png(read_bytes(folder / "lit/box-solution.png")));
  const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
  const auto patches = json["patches"].get<uint64_t>();
  CHECK(json["solver"] == "matrix");
  CHECK(json["form_factors_found"].get<uint64_t>() == patches * patches);
  CHECK(json["stopped"]["reason"] == "converged");
  CHECK(json["solutions"].size() == 1);
}

TEST_CASE("shots are pictured when asked for, and the run ends with the last of them") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child(words(
      folder, {"--solver", "shooting", "--shots", "1,20", "--max-patches", "200", "--format", "png,exr"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(list_names(folder / "lit") ==
        "box-report.json box-shot-000001.exr box-shot-000001.png box-shot-000020.exr box-shot-000020.png");
  const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
  CHECK(json["stopped"]["shot"] == 20);
  CHECK(json["stopped"]["reason"] == "shots");
  CHECK(json["shots"].size() == 20);
}

TEST_CASE("shooting without an asked shot goes on until it has converged") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result =
      run_child(words(folder, {"--solver", "shooting", "--ambient", "--max-patches", "200"}));
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(list_names(folder / "lit") == "box-report.json box-solution-ambient.png");
  const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
  CHECK(json["stopped"]["reason"] == "converged");
  CHECK(json["stopped"]["shot"].get<int>() > 20);
}

TEST_CASE("a matrix that memory does not hold is refused before the solve") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  for (const std::vector<std::string>& flags :
       {std::vector<std::string>{"--max-patches", "3000", "--max-memory", "100M"},
        std::vector<std::string>{"--max-patches", "1000000000"}}) {
    std::vector<std::string> more = {"--solver", "matrix"};
    more.insert(more.end(), flags.begin(), flags.end());
    const ChildResult result = run_child(words(folder, more));
    CHECK(result.exit_code == 5);
    CHECK_MESSAGE(result.err.find("error[memory-limit]") != std::string::npos, result.err);
  }
}

TEST_CASE(
    "a matrix of all the patches that a scene starts with is refused for its memory, and another way named") {
  const Folder folder;
  // 512 x 512 patches on the floor: a matrix of half a terabyte.
  std::string text(kBoxScene);
  const size_t at = text.find("subdivide: 4");
  REQUIRE(at != std::string::npos);
  write_bytes(folder / "box.yaml", text.replace(at, 12, "subdivide: 400"));
  const ChildResult result = run_child(words(folder, {"--solver", "matrix"}));
  CHECK(result.exit_code == 5);
  CHECK_MESSAGE(result.err.find("error[memory-limit]: --solver matrix") != std::string::npos, result.err);
  CHECK_MESSAGE(result.err.find("--solver passes") != std::string::npos, result.err);
}

TEST_CASE("a scene in which light never dies has no solution by the matrix: a mistake of the scene") {
  const Folder folder;
  write_bytes(folder / "box.yaml",
              "patchlight: 1\nmaterials:\n  white: {reflectance: 1}\n  lamp: {reflectance: 1, emission: 1}\n"
              "objects:\n  - {room: {size: [1, 1, 1], walls: {ceiling: lamp}}, material: white}\n");
  const ChildResult result = run_child(words(folder, {"--solver", "matrix", "--max-patches", "100"}));
  CHECK(result.exit_code == 3);
  CHECK_MESSAGE(result.err.find("error[singular-system]") != std::string::npos, result.err);
}

TEST_CASE("flags of one solver are never ignored by another") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--shots", "3"},
                                                {"--ambient"},
                                                {"--solver", "matrix", "--shots", "3"},
                                                {"--solver", "matrix", "--passes", "3"},
                                                {"--solver", "shooting", "--snapshots", "all"},
                                                {"--solver", "gauss"},
                                                {"--solver", "shooting", "--shots", "0"}}) {
    const ChildResult result = run_child(words(folder, flags));
    CHECK(result.exit_code == 2);
    CHECK_MESSAGE(result.err.find("error[usage]") != std::string::npos, result.err);
  }
}
