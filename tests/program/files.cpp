// Disks and streams that fail: exit code 4, and no half a file.
#include "child.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace patchlight::testing;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("-o on a file ends with 4 before the solve") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  write_bytes(folder / "lit", "");
  const ChildResult result = run_child(render_words(folder / "box.yaml", folder / "lit"));
  CHECK(result.exit_code == 4);
  CHECK(has(result.err, "error[cannot-write]"));
  CHECK(read_bytes(folder / "lit").empty());
}

TEST_CASE("a picture that does not fit leaves nothing under any name") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  ChildSettings settings;
  settings.file_bytes_max = 200;  // Room for messages, not for a picture.
  const ChildResult result =
      run_child(render_words(folder / "box.yaml", folder / "lit", {"--quiet"}), settings);
  CHECK(result.exit_code == 4);
  CHECK(has(result.err, "error[write-failed]"));
  CHECK(has(result.err, "File too large"));
  CHECK(list_names(folder / "lit").empty());
}

TEST_CASE("results that cannot be written end with 4") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  ChildSettings settings;
  settings.output = "/dev/full";
  const ChildResult full = run_child({"check", folder / "box.yaml"}, settings);
  CHECK(full.exit_code == 4);
  CHECK(has(full.err, "error[write-failed]"));
  CHECK(run_child({"check", folder / "box.yaml", "--json"}, settings).exit_code == 4);
}

TEST_CASE("a closed standard output ends with 4, and no file takes its place") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  ChildSettings settings;
  settings.output_closed = true;
  const ChildResult result = run_child(render_words(folder / "box.yaml", folder / "lit"), settings);
  CHECK(result.exit_code == 4);
  CHECK(has(result.err, "error[write-failed]"));
  CHECK(!std::filesystem::exists(folder / "lit"));
  CHECK(run_child({"check", folder / "box.yaml", "--json"}, settings).exit_code == 4);
}

TEST_CASE("a reader that goes away is no mistake") {
  const Folder folder;
  write_bytes(folder / "box.yaml", kBoxScene);
  const std::string command =
      "set -o pipefail; '" PATCHLIGHT_PROGRAM "' check --json '" + folder / "box.yaml" + "' | true";
  const int status = std::system(("bash -c \"" + command + "\"").c_str());
  CHECK(status == 0);
}
