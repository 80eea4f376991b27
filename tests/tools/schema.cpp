// The schema is shipped as the program makes it, and judges scenes as the loader does.
#include "tools/schema.h"

#include "dsl/scene/load.h"
#include "tests/folder.h"
#include "tools/json.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

const std::string kRoot = PATCHLIGHT_SOURCE_DIR;

std::vector<std::string> scene_files(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(kRoot + "/" + folder))
    if (entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
  return paths;
}

// Slug of the first error of loading a text; empty where there is none.
std::string first_slug(const std::string& text) {
  std::vector<Diagnostic> warnings;
  try {
    load_scene_text(text, "t.yaml", warnings);
  } catch (const UserError& error) {
    return error.diagnostics.front().slug;
  }
  return {};
}

}  // namespace

TEST_CASE("scenes/patchlight.schema.json is what the program prints") {
  CHECK_MESSAGE(read_bytes(kRoot + "/scenes/patchlight.schema.json") == format_schema(),
                "write it anew: patchlight schema > scenes/patchlight.schema.json");
}

TEST_CASE("every scene names the schema in its first line, and so do the parts of scenes") {
  const std::vector<std::string> paths = scene_files("scenes"), parts = scene_files("scenes/parts");
  REQUIRE(paths.size() >= 19);
  for (const std::string& path : paths)
    CHECK_MESSAGE(
        read_bytes(path).starts_with("# yaml-language-server: $schema=./patchlight.schema.json\n# "), path);
  REQUIRE(parts.size() >= 4);
  for (const std::string& path : parts)
    CHECK_MESSAGE(
        read_bytes(path).starts_with("# yaml-language-server: $schema=../patchlight.schema.json\n# "), path);
}

TEST_CASE("every property of the schema says what it is") {
  const Json schema = Json::parse(format_schema());
  size_t count = 0;
  const auto check = [&](const Json& table) {
    if (!table.contains("properties")) return;
    for (const auto& [key, property] : table["properties"].items()) {
      CAPTURE(key);
      CHECK(property["description"].get<std::string>().size() > 5);
      ++count;
    }
  };
  check(schema);
  for (const auto& [name, table] : schema["definitions"].items()) check(table);
  CHECK(count > 80);
  CHECK(schema["definitions"]["camera"]["properties"]["up"]["default"] == Json({0, 1, 0}));
  CHECK(schema["definitions"]["solver"]["properties"]["passes"]["default"] == 16);
  CHECK(schema["definitions"]["cylinder"]["properties"]["caps"]["default"] == true);
  CHECK(schema["definitions"]["output"]["properties"]["shading"]["default"] == "smooth");
}

TEST_CASE("the loader takes the scenes that the schema's test takes, without a warning of its keys") {
  std::vector<Diagnostic> warnings;
  for (const char* name : {"everything", "smallest"}) {
    CAPTURE(name);
    CHECK_NOTHROW(load_scene(kRoot + "/tests/schema/right/" + name + ".yaml", warnings));
  }
  CHECK(warnings.empty());
}

TEST_CASE("the loader refuses the scenes that the schema's test refuses") {
  const std::string all = "\n---\n" + read_bytes(kRoot + "/tests/schema/wrong_scenes.yaml");
  size_t count = 0;
  for (size_t begin = 0; begin != std::string::npos;) {
    begin += 5;
    const size_t end = all.find("\n---\n", begin);
    const std::string scene = all.substr(begin, end - begin);
    CAPTURE(scene);
    const std::string slug = first_slug(scene);
    CHECK(!slug.empty());
    CHECK(exit_code(slug) == 3);
    ++count;
    begin = end;
  }
  CHECK(count >= 60);
}
