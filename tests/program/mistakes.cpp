// What users do wrong, and limits: exit code, slug, place; and nothing written.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("usage errors end with 2") {
  for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                {"rendr"},
                                                {"render"},
                                                {"render", "a.yaml", "--frob"},
                                                {"render", "a.yaml", "--threads", "0"},
                                                {"render", "a.yaml", "--threads", "1000000"}}) {
    const ChildResult result = run_child(words);
    CHECK(result.exit_code == 2);
    CHECK(has(result.err, "error[usage]: "));
    CHECK(result.out.empty());
  }
}

TEST_CASE("a scene that is not there, or is a directory, ends with 4") {
  const ChildResult missing = run_child({"render", "nope.yaml"});
  CHECK(missing.exit_code == 4);
  CHECK(has(missing.err, "nope.yaml"));
  CHECK(has(missing.err, "error[cannot-open]"));
  CHECK(has(missing.err, "No such file or directory"));
  const ChildResult directory = run_child({"render", "/"});
  CHECK(directory.exit_code == 4);
  CHECK(has(directory.err, "error[not-a-regular-file]"));
}

TEST_CASE("an empty standard input is an empty scene") {
  const ChildResult result = run_child({"render", "-"});
  CHECK(result.exit_code == 3);
  CHECK(has(result.err, "<stdin>:1:1: error[empty-scene]"));
}

TEST_CASE("a wrong scene ends with 3, its place and nothing written") {
  const Folder folder;
  std::string scene = kBoxScene;
  scene.replace(scene.find("material: white"), 15, "material: whte");
  write_bytes(folder / "box.yaml", scene);
  const ChildResult result = run_child(render_words(folder / "box.yaml", folder / "lit"));
  CHECK(result.exit_code == 3);
  CHECK(has(result.err, "box.yaml:6:"));
  CHECK(has(result.err, "error[unknown-material]"));
  CHECK(has(result.err, "'white'"));
  CHECK(!std::filesystem::exists(folder / "lit"));
}

TEST_CASE("a mesh that is missing ends with 4, one that is wrong with 3 and its place in the OBJ file") {
  const Folder folder;
  write_bytes(folder / "box.yaml", std::string(kBoxScene) + "  - {mesh: model.obj, material: white}\n");
  const ChildResult missing = run_child({"check", folder / "box.yaml"});
  CHECK(missing.exit_code == 4);
  CHECK(has(missing.err, "box.yaml:9:12: error[cannot-open]"));
  write_bytes(folder / "model.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n");
  const ChildResult wrong = run_child({"check", folder / "box.yaml"});
  CHECK(wrong.exit_code == 3);
  CHECK(has(wrong.err, "model.obj:3:3: error[non-finite]"));
  write_bytes(folder / "model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK(run_child({"check", folder / "box.yaml"}).exit_code == 0);
}

TEST_CASE("check --json lists the messages on standard output") {
  const Folder folder;
  std::string scene = kBoxScene;
  scene.replace(scene.find("material: white"), 15, "material: whte");
  write_bytes(folder / "box.yaml", scene);
  const ChildResult result = run_child({"check", folder / "box.yaml", "--json"});
  CHECK(result.exit_code == 3);
  const Json json = Json::parse(result.out);
  REQUIRE(json.size() >= 1);
  CHECK(json[0]["severity"] == "error");
  CHECK(json[0]["slug"] == "unknown-material");
  CHECK(json[0]["line"] == 6);
  CHECK(json[0]["column"].get<int>() > 0);
  for (const char* field : {"file", "message"}) CHECK(json[0].contains(field));

  write_bytes(folder / "right.yaml", kBoxScene);
  const ChildResult right = run_child({"check", folder / "right.yaml", "--json"});
  CHECK(right.exit_code == 0);
  CHECK(Json::parse(right.out).is_array());
}

TEST_CASE("mistakes of the command line are on the JSON list too") {
  const ChildResult result = run_child({"check", "a.yaml", "--json", "--frob"});
  CHECK(result.exit_code == 2);
  CHECK(Json::parse(result.out)[0]["slug"] == "usage");
}

TEST_CASE("-D changes the scene, and a wrong value there ends with 2") {
  const Folder folder;
  write_bytes(folder / "box.yaml", std::string(kBoxScene) + "let: {n: 1}\nsolver: {passes: $n}\n");
  const std::vector<std::string> words = {"check", folder / "box.yaml", "--snapshots", "3"};
  CHECK(run_child(words).exit_code == 3);
  std::vector<std::string> more = words;
  more.insert(more.end(), {"-D", "n=3"});
  CHECK(run_child(more).exit_code == 0);
  more.back() = "n=.nan";
  CHECK(run_child(more).exit_code == 2);
  more.back() = "n=1";
  more.insert(more.end(), {"--set", "solver.passes=4"});
  CHECK(run_child(more).exit_code == 0);
}

TEST_CASE("limits end with 5 and name their number") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult image = run_child({"check", folder / "box.yaml", "--size", "20000x10"});
  CHECK(image.exit_code == 5);
  CHECK(has(image.err, "error[image-too-large]"));
  CHECK(has(image.err, "16384"));
  const ChildResult patches = run_child({"check", folder / "box.yaml", "--max-patches", "3"});
  CHECK(patches.exit_code == 5);
  CHECK(has(patches.err, "error[too-many-patches]"));
  const ChildResult memory =
      run_child({"check", folder / "box.yaml", "--max-patches", "1000000000", "--size", "8000x8000"});
  CHECK(memory.exit_code == 5);
  CHECK(has(memory.err, "error[memory-limit]"));
  CHECK(has(memory.err, "--max-memory"));
  const ChildResult time = run_child({"check", folder / "box.yaml", "--max-seconds", "0.001"});
  CHECK(time.exit_code == 5);
  CHECK(has(time.err, "error[time-limit]"));
  // Refused before the solve: nothing is written.
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--max-seconds", "0.001"},
                                             {"--max-memory", "1000"},
                                             {"--max-polygons", "2"},
                                             {"--max-values", "9"}}) {
    const ChildResult refused = run_child(render_words(folder / "box.yaml", folder / "lit", more));
    CHECK(refused.exit_code == 5);
    CHECK(has(refused.err, more[0]));
    CHECK(!std::filesystem::exists(folder / "lit"));
  }
}

// The address sanitizer takes terabytes of addresses before the program begins.
#ifndef __SANITIZE_ADDRESS__
TEST_CASE("where the system gives no more memory while a scene loads, that is said, with 5") {
  const Folder folder;
  std::string text = "patchlight: 1\nmaterials: {w: {emission: 1}}\nobjects:\n";
  for (int k = 0; k < 200'000; ++k) text += "  - {quad: {size: [1, 1]}, material: w}\n";
  write_bytes(folder / "many.yaml", text);
  ChildSettings settings;
  settings.address_bytes_max = 130'000'000;  // The libraries take 60 MB, the scene 170 MB.
  const ChildResult result = run_child({"check", folder / "many.yaml"}, settings);
  CHECK(result.exit_code == 5);
  CHECK(has(result.err, "error[out-of-memory]: the system gives no more memory"));
}
#endif

TEST_CASE("check forecasts memory and time") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child({"check", folder / "box.yaml", "--threads", "1"});
  CHECK(result.exit_code == 0);
  CHECK(has(result.out, "memory            likely "));
  CHECK(has(result.out, ", at most "));
  CHECK(has(result.out, "time              likely "));
  CHECK(has(result.out, " on 1 thread; an estimate by counts of rays\n"));
}

TEST_CASE("a snapshot beyond the passes ends with 3") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const ChildResult result = run_child({"check", folder / "box.yaml", "--passes", "4", "--snapshots", "1,5"});
  CHECK(result.exit_code == 3);
  CHECK(has(result.err, "error[snapshot-beyond-passes]"));
}

TEST_CASE("--color always colours the severity, never and a file do not") {
  CHECK(
      has(run_child({"check", "nope.yaml", "--color", "always"}).err, "\x1b[1;31merror[cannot-open]\x1b[0m"));
  CHECK(!has(run_child({"check", "nope.yaml"}).err, "\x1b"));
}
