// The verb factors, run as users do.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <sstream>
#include <thread>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

constexpr const char* kTwoPlates = R"(patchlight: 1
let: {gap: 1}
materials: {grey: {reflectance: 0.5}}
objects:
  - {id: low, quad: {size: [1, 1]}, material: grey}
  - {id: high, quad: {center: [0, $gap, 0], size: [1, 1], normal: [0, -1, 0]}, material: grey}
)";

std::vector<std::vector<std::string>> split_table(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

// A face of a model whose corners lie anywhere in space: its hundreds of triangles all see each other in
// part, and find no end of rays.
void write_tangle(const Folder& folder) {
  std::string model, face = "f";
  uint64_t state = 1;
  const auto draw = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 40) * 0x1p-24;
  };
  for (int k = 1; k <= 300; ++k) {
    model += 'v';
    for (int axis = 0; axis < 3; ++axis) {
      model += ' ';
      model += std::to_string(draw());
    }
    model += '\n';
    face += ' ';
    face += std::to_string(k);
  }
  write_bytes(folder / "tangle.obj", model + face + "\n");
  write_bytes(folder / "tangle.yaml",
              "patchlight: 1\nmaterials: {grey: {reflectance: 0.5}}\n"
              "objects: [{id: tangle, mesh: tangle.obj, material: grey}]\n");
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("factors prints a table on standard output and a summary on standard error") {
  const Folder folder;
  write_bytes(folder / "plates.yaml", kTwoPlates);
  const ChildResult result = run_child({"factors", folder / "plates.yaml"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto rows = split_table(result.out);
  REQUIRE(rows.size() == 3);
  CHECK(rows[0] == std::vector<std::string>{"polygon", "area", "low", "high", "row_sum", "row_error"});
  CHECK(rows[1][0] == "low");
  CHECK(std::stod(rows[1][1]) == doctest::Approx(1).epsilon(1e-6));
  CHECK(std::stod(rows[1][2]) == 0);
  CHECK(std::stod(rows[1][3]) == doctest::Approx(0.199824895698).epsilon(5e-6));
  CHECK(std::stod(rows[1][4]) == std::stod(rows[1][3]));
  CHECK(std::stod(rows[1][5]) == 0);
  for (const char* word : {"2 polygons", "row sums", "low", "high"})
    CHECK_MESSAGE(has(result.err, word), word);
  // A scene without a lamp is no mistake here.
  CHECK(!has(result.err, "warning"));
  CHECK(list_names(folder.path) == "plates.yaml");
}

TEST_CASE("factors of the scene of view factors are the published ones that stand in it") {
  const std::string scene = std::string(PATCHLIGHT_SOURCE_DIR) + "/scenes/view_factors.yaml";
  const ChildResult result = run_child({"factors", scene, "--format", "json", "--quiet"});
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.empty());
  const Json json = Json::parse(result.out);
  std::map<std::string, size_t> index;
  for (const Json& polygon : json["polygons"]) index.emplace(polygon["id"], index.size());
  // "#   from -> to   0.123456": the figures as they stand in the file.
  std::istringstream lines(read_bytes(scene));
  size_t compared = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string hash, from, arrow, to, figure;
    if (!(words >> hash >> from >> arrow >> to >> figure) || hash != "#" || arrow != "->") continue;
    CAPTURE(line);
    REQUIRE(index.contains(from));
    REQUIRE(index.contains(to));
    const double found = json["form_factors"][index[from]][index[to]];
    const double error = json["errors"][index[from]][index[to]];
    CHECK(error <= 1e-3);
    // Half of the last digit of the figure, and what rays may be off.
    CHECK(std::abs(found - std::stod(figure)) <= 1e-6 + error);
    ++compared;
  }
  CHECK(compared == 6);
  // The L-shaped room is closed.
  for (const auto& [id, row] : index)
    if (id.starts_with("lroom"))
      CHECK(std::abs(json["row_sums"][row].get<double>() - 1) <=
            json["row_errors"][row].get<double>() + 1e-6);
  CHECK(json["reciprocity_error_max"].get<double>() <= 1e-15);
  // Plates at other distances.
  for (const auto& [gap, figure] : {std::pair("0.1", 0.826995), std::pair("10", 0.00316206)}) {
    const ChildResult plates =
        run_child({"factors", scene, "-D", std::string("gap=") + gap, "--format", "json", "--quiet"});
    const double found = Json::parse(plates.out)["form_factors"][index["plate.low"]][index["plate.high"]];
    CHECK(std::abs(found - figure) <= 1e-6);
  }
}

TEST_CASE("factors: -D changes the scene, and the table is the same with any number of threads") {
  const Folder folder;
  write_bytes(folder / "plates.yaml", kTwoPlates);
  const ChildResult near = run_child({"factors", folder / "plates.yaml", "-D", "gap=0.1", "--quiet"});
  REQUIRE(near.exit_code == 0);
  CHECK(std::stod(split_table(near.out)[1][3]) == doctest::Approx(0.826994522397).epsilon(5e-6));
  const std::string scene = std::string(PATCHLIGHT_SOURCE_DIR) + "/scenes/l_room.yaml";
  const ChildResult one = run_child({"factors", scene, "--threads", "1"});
  const ChildResult three = run_child({"factors", scene, "--threads", "3"});
  const ChildResult other = run_child({"factors", scene, "--seed", "2"});
  REQUIRE(one.exit_code == 0);
  CHECK((one.out == three.out));
  CHECK((one.out != other.out));
}

TEST_CASE("factors reads a scene from standard input, two-sided polygons have two rows") {
  ChildSettings settings;
  settings.input = std::string(kTwoPlates) +
                   "  - {id: screen, quad: {center: [0, 0.5, 0], size: [0.5, 0.5]}, material: grey, "
                   "two_sided: true}\n";
  const ChildResult result = run_child({"factors", "-", "--quiet"}, settings);
  REQUIRE(result.exit_code == 0);
  const auto rows = split_table(result.out);
  REQUIRE(rows.size() == 5);
  CHECK(rows[3][0] == "screen");
  CHECK(rows[4][0] == "screen.back");
}

TEST_CASE("mistakes of factors have their slugs and codes, and nothing is printed") {
  const Folder folder;
  write_bytes(folder / "plates.yaml", kTwoPlates);
  const auto check = [&](const std::vector<std::string>& more, int code, const char* slug) {
    std::vector<std::string> words = {"factors", folder / "plates.yaml"};
    words.insert(words.end(), more.begin(), more.end());
    const ChildResult result = run_child(words);
    CAPTURE(slug);
    CHECK(result.exit_code == code);
    CHECK(has(result.err, std::string("error[") + slug + "]"));
    CHECK(result.out.empty());
  };
  check({"--format", "png"}, 2, "usage");
  check({"--error", "0"}, 2, "usage");
  check({"--passes", "3"}, 2, "usage");
  check({"-D", "nope=1"}, 2, "undefined-variable");
  check({"--set", "objects.0.material=whte"}, 3, "unknown-material");
  check({"--max-memory", "1000"}, 5, "memory-limit");
  CHECK(run_child({"factors", folder / "nope.yaml"}).exit_code == 4);
  ChildSettings closed;
  closed.output_closed = true;
  CHECK(run_child({"factors", folder / "plates.yaml"}, closed).exit_code == 4);
}

TEST_CASE("factors --json lists messages on standard output, and no table") {
  const Folder folder;
  write_bytes(folder / "plates.yaml", kTwoPlates);
  const ChildResult right = run_child({"factors", folder / "plates.yaml", "--json"});
  CHECK(right.exit_code == 0);
  CHECK(Json::parse(right.out) == Json::array());
  const ChildResult wrong = run_child({"factors", folder / "plates.yaml", "--json", "--max-memory", "1"});
  CHECK(wrong.exit_code == 5);
  CHECK(Json::parse(wrong.out)[0]["slug"] == "memory-limit");
}

TEST_CASE("factors warns where rays run out before the error is reached") {
  // A hair's breadth of doubt: a millionth takes more rays than a pair gets.
  ChildSettings settings;
  settings.input = std::string(kTwoPlates) +
                   "  - {id: screen, quad: {center: [0.25, 0.5, 0.25], size: [0.5, 0.5]}, material: grey}\n";
  const ChildResult result = run_child({"factors", "-", "--error", "0.000001", "--format", "json"}, settings);
  CHECK(result.exit_code == 0);
  CHECK(has(result.err, "warning[not-converged]"));
  CHECK(Json::parse(result.out)["error_max"]["error"].get<double>() > 1e-6);
}

TEST_CASE("factors ends in order soon after a signal, in the middle of a pair") {
  for (const auto& [signal, name] : {std::pair<int, std::string>{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}}) {
    CAPTURE(name);
    const Folder folder;
    write_tangle(folder);
    Child child;
    start_child(child, {"factors", folder / "tangle.yaml", "--error", "1e-5"});
    std::this_thread::sleep_for(std::chrono::seconds(1));  // loaded long before
    kill(child.process, signal);
    const auto sent = std::chrono::steady_clock::now();
    const ChildResult result = finish_child(child);
    INFO(result.err);
    CHECK(result.exit_code == 128 + signal);
    // Seldom more than a hundredth of a second; a machine may be busy.
    CHECK(std::chrono::steady_clock::now() - sent < std::chrono::seconds(5));
    CHECK(has(result.err, "stopped by " + name));
    CHECK(result.out.empty());
  }
}

TEST_CASE("factors ends at --max-seconds with its slug, and prints nothing") {
  const Folder folder;
  write_tangle(folder);
  const ChildResult result =
      run_child({"factors", folder / "tangle.yaml", "--error", "1e-5", "--max-seconds", "0.5"});
  INFO(result.err);
  CHECK(result.exit_code == 5);
  CHECK(has(result.err, "error[time-limit]"));
  CHECK(result.out.empty());
}
