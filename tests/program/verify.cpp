// The verbs verify, show, schema and completion, as users call them.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>
#include <signal.h>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A furnace: after pass k every patch shows 1 - 0.5^(k + 1).
const std::string kFurnace = R"(patchlight: 1
materials: {glow: {reflectance: 0.5, emission: 0.5}}
objects:
  - {id: hall, room: {size: [1, 1, 1]}, material: glow}
solver: {passes: 4, until: 0, max_patches: 2000, rays: 32}
)";

ChildResult verify(const std::string& scene, const std::vector<std::string>& more = {}) {
  const Folder folder;
  write_bytes(folder / "furnace.yaml", scene);
  std::vector<std::string> words = {"verify", folder / "furnace.yaml"};
  words.insert(words.end(), more.begin(), more.end());
  const ChildResult result = run_child(words);
  CHECK(list_names(folder.path) == "furnace.yaml");
  return result;
}

}  // namespace

TEST_CASE("verify ends with 0 where every expectation is met, after its own pass") {
  // Closed rooms are exact; 1e-3 is far below the steps between the passes.
  const ChildResult result = verify(kFurnace + R"(expect:
  - {object: hall.floor, pass: 0, radiosity: 0.5, tolerance: 0.001}
  - {object: hall, pass: 1, radiosity: 0.75, tolerance: 0.001}
  - {object: hall.left, pass: 2, radiosity: [0.875, 0.875, 0.875], tolerance: 0.001}
  - {object: hall, radiosity: 0.96875, tolerance: 0.001}
)");
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(has(result.out, "hall.left, pass 2: expected [0.875, 0.875, 0.875] within 0.1 %, found [0.875"));
  CHECK(has(result.out, "hall, pass 4: "));
  CHECK(!has(result.out, "differs"));
  CHECK(has(result.err, "4 of 4 expectations are met"));
}

TEST_CASE("the shipped scenes that say what they expect are as they say") {
  for (const char* name : {"furnace", "form_factors"}) {
    CAPTURE(name);
    const ChildResult result =
        run_child({"verify", std::string(PATCHLIGHT_SOURCE_DIR) + "/scenes/" + name + ".yaml"});
    INFO(result.out);
    CHECK(result.exit_code == 0);
    CHECK(has(result.err, "3 of 3 expectations are met"));
  }
}

TEST_CASE("verify ends with 1 at a difference, and says found and wanted") {
  const std::string scene =
      kFurnace +
      "expect:\n  - {object: hall.floor, pass: 1, radiosity: 0.75, tolerance: 0.001}\n"
      "  - {object: hall.left, pass: 1, radiosity: [0.75, 0.75, 0.8], tolerance: 0.01}\n";
  const ChildResult result = verify(scene);
  CHECK(result.exit_code == 1);
  CHECK(has(result.out, "as said hall.floor"));
  CHECK(has(result.out, "differs hall.left, pass 1: expected [0.75, 0.75, 0.8] within 1 %, found [0.75"));
  CHECK(has(result.err, "1 of 2 expectations are met"));

  const ChildResult listed = verify(scene, {"--json"});
  CHECK(listed.exit_code == 1);
  const Json messages = Json::parse(listed.out);
  REQUIRE(messages.size() == 1);
  CHECK(messages[0]["slug"] == "expectation-missed");
  CHECK(messages[0]["severity"] == "error");
  CHECK(messages[0]["line"] == 8);
  CHECK(has(messages[0]["message"], "hall.left"));
}

TEST_CASE("an expectation without a pass follows the last one; a named one cannot be left out") {
  const std::string last = kFurnace + "expect: [{object: hall, radiosity: 0.875, tolerance: 0.001}]\n";
  CHECK(verify(last).exit_code == 1);
  CHECK(verify(last, {"--passes", "2"}).exit_code == 0);
  const ChildResult result =
      verify(kFurnace + "expect: [{object: hall, pass: 3, radiosity: 1}]\n", {"--passes", "2"});
  CHECK(result.exit_code == 3);
  CHECK(has(result.err, "error[snapshot-beyond-passes]"));
}

TEST_CASE("a run that converged earlier is compared as it stands at its end") {
  const std::string scene =
      kFurnace + "expect: [{object: hall, pass: 4, radiosity: 0.875, tolerance: 0.001}]\n";
  // Pass 2 adds half of what pass 1 added, and 0.5 is not below 0.6.
  CHECK(verify(scene, {"--set", "solver.until=0.6"}).exit_code == 0);
}

TEST_CASE("verify needs something to compare with") {
  const ChildResult result = verify(kFurnace);
  CHECK(result.exit_code == 3);
  CHECK(has(result.err, "error[missing-key]: the scene expects nothing: add `expect:`"));
}

TEST_CASE("show prints the merged settings with their origins, and wants to be told so") {
  const Folder folder;
  write_bytes(folder / "furnace.yaml", kFurnace);
  const ChildResult result =
      run_child({"show", folder / "furnace.yaml", "--effective", "--rays", "16", "--set", "solver.seed=9"});
  CHECK(result.exit_code == 0);
  CHECK(has(result.out, "solver.rays "));
  CHECK(has(result.out, " --rays\n"));
  CHECK(has(result.out, " --set solver.seed\n"));
  CHECK(has(result.out, "furnace.yaml:5:18\n"));
  CHECK(has(result.out, " built-in\n"));
  CHECK(run_child({"show", folder / "furnace.yaml"}).exit_code == 2);
}

TEST_CASE("schema and completion print to standard output") {
  const ChildResult schema = run_child({"schema"});
  CHECK(schema.exit_code == 0);
  CHECK(Json::parse(schema.out)["$schema"] == "http://json-schema.org/draft-07/schema#");
  CHECK(has(run_child({"completion", "bash"}).out, "complete -F _patchlight patchlight\n"));
  const ChildResult wrong = run_child({"completion", "fish"});
  CHECK(wrong.exit_code == 2);
  CHECK(has(wrong.err, "expected one of bash, zsh"));
}

TEST_CASE("a run that must converge ends with 6 where it does not") {
  const Folder folder;
  write_bytes(folder / "furnace.yaml", kFurnace);
  const std::vector<std::string> words =
      render_words(folder / "furnace.yaml", folder / "lit", {"--format", "csv"});
  std::vector<std::string> strict = words;
  strict.push_back("--require-convergence");
  CHECK(run_child(words).exit_code == 0);
  CHECK(run_child(strict).exit_code == 6);
  strict.insert(strict.end(), {"--set", "solver.until=0.9"});
  CHECK(run_child(strict).exit_code == 0);
}

TEST_CASE("--max-memory refuses a run that may need more, and says how to go on") {
  const Folder folder;
  write_bytes(folder / "furnace.yaml", kFurnace);
  const ChildResult result = run_child({"check", folder / "furnace.yaml", "--max-memory", "100k"});
  CHECK(result.exit_code == 5);
  CHECK(has(result.err, "error[memory-limit]"));
  CHECK(has(result.err, "the limit is 0.1 MB, what is available unless --max-memory says another"));
  CHECK(run_child({"check", folder / "furnace.yaml", "--max-memory", "2G"}).exit_code == 0);
}
