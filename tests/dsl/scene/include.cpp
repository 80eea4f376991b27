// Includes: names, order, and where files may lie.
#include "dsl/scene/include.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace patchlight::test {
namespace {

namespace fs = std::filesystem;

// A folder of its own for a test's files, gone afterwards.
struct Folder {
  fs::path path = fs::temp_directory_path() / fmt::format("patchlight_include_{}", ::getpid());
  Folder() { fs::create_directories(path / "parts"); }
  ~Folder() { fs::remove_all(path); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
  Loaded load(const std::string& text) const {
    write("scene.yaml", text);
    Loaded loaded;
    try {
      loaded.scene = load_scene((path / "scene.yaml").string(), loaded.warnings);
    } catch (const UserError& error) {
      loaded.errors = error.diagnostics;
    }
    return loaded;
  }
};

const std::string kLamps =
    "patchlight: 1\nlet: {size: 2}\nmaterials: {glow: {emission: 5}}\nobjects:\n"
    "  - {id: lamp, quad: {size: [$size, 1]}, material: glow}\n";

TEST_CASE("an include adds its names, with `as` behind a prefix") {
  const Folder folder;
  folder.write("parts/lamps.yaml", kLamps);
  const Loaded plain = folder.load(
      "patchlight: 1\ninclude: [parts/lamps.yaml]\nobjects:\n  - {id: b, quad: {size: [1, $size], center: "
      "[0,2,0]}, material: glow}\n");
  REQUIRE(plain.errors.empty());
  CHECK(plain.scene.polygons.id == std::vector<std::string>{"lamp", "b"});
  const Loaded named = folder.load(
      "patchlight: 1\ninclude: [{file: parts/lamps.yaml, as: l}]\nobjects:\n  - {id: lamp, quad: {size: [1, "
      "$l.size], center: [0,2,0]}, material: l.glow}\n");
  REQUIRE(named.errors.empty());
  CHECK(named.scene.polygons.id == std::vector<std::string>{"l.lamp", "lamp"});
}

TEST_CASE("a file that two others include is read once") {
  const Folder folder;
  folder.write("parts/d.yaml", "patchlight: 1\nmaterials: {glow: {emission: 5}}\n");
  folder.write("b.yaml", "patchlight: 1\ninclude: [parts/d.yaml]\n");
  folder.write("c.yaml", "patchlight: 1\ninclude: [parts/../parts/d.yaml]\n");
  const Loaded loaded = folder.load(
      "patchlight: 1\ninclude: [b.yaml, c.yaml]\nobjects: [{quad: {size: [1,1]}, material: glow}]\n");
  CHECK(loaded.errors.empty());
}

TEST_CASE("files that include each other are told with their chain") {
  const Folder folder;
  folder.write("b.yaml", "patchlight: 1\ninclude: [c.yaml]\n");
  folder.write("c.yaml", "patchlight: 1\ninclude: [scene.yaml]\n");
  const Loaded loaded = folder.load("patchlight: 1\ninclude: [b.yaml]\nobjects: []\n");
  REQUIRE(!loaded.errors.empty());
  CHECK(loaded.errors[0].slug == "include-cycle");
  CHECK(loaded.errors[0].message.find("scene.yaml -> b.yaml -> c.yaml -> scene.yaml") != std::string::npos);
  CHECK(loaded.errors[0].file == "c.yaml");
}

TEST_CASE("nothing outside of the scene's folder is read") {
  const Folder folder;
  fs::create_directory_symlink("/etc", folder.path / "link");
  for (const char* name : {"/etc/hostname", "../x.yaml", "link/hostname", "parts/../../x.yaml"}) {
    CAPTURE(name);
    const Loaded loaded = folder.load(fmt::format("patchlight: 1\ninclude: [{}]\nobjects: []\n", name));
    REQUIRE(!loaded.errors.empty());
    CHECK(loaded.errors[0].slug == "include-outside-root");
    CHECK(loaded.errors[0].line == 2);
    CHECK(loaded.errors[0].column == 11);
  }
}

TEST_CASE("mistakes in an included file are told in that file") {
  const Folder folder;
  folder.write("b.yaml", "patchlight: 1\nsolver: {}\nmaterials: {m: {reflektance: 1}}\nunits: mm\n");
  const Loaded loaded = folder.load(
      "patchlight: 1\ninclude: [b.yaml, nope.yaml, parts]\nobjects: [{quad: {size: [1,1]}, material: m}]\n");
  REQUIRE(loaded.errors.size() == 5);
  CHECK(count_slug(loaded.errors, "unknown-key") == 2);
  CHECK(count_slug(loaded.errors, "bad-unit") == 1);
  CHECK(count_slug(loaded.errors, "include-not-found") == 1);
  CHECK(count_slug(loaded.errors, "not-a-regular-file") == 1);
}

TEST_CASE("names that two files give are told with both places; a newer version is told in its file") {
  const Folder folder;
  folder.write("b.yaml",
               "materials: {m: {emission: 1}}\nlet: {n: 1}\nobjects:\n  - {id: o, quad: {size: [1, 1]}, "
               "material: m}\n");
  const Loaded loaded = folder.load(
      "patchlight: 1\ninclude: [b.yaml]\nmaterials: {m: {}}\nlet: {n: 2}\n"
      "objects:\n  - {id: o, quad: {size: [1, 1], center: [0, 1, 0]}, material: m}\n");
  REQUIRE(loaded.errors.size() == 3);
  CHECK(count_slug(loaded.errors, "duplicate-id") == 3);
  CHECK(loaded.errors[0].message == "the material 'm' is taken: first defined at b.yaml:1:13");
  CHECK(loaded.errors[1].message == "the variable 'n' is taken: first defined at b.yaml:2:10");
  CHECK(loaded.errors[2].message == "the id 'o' is taken: first defined at b.yaml:4:10");
  folder.write("b.yaml", "patchlight: 2\n");
  const Loaded newer = folder.load("patchlight: 1\ninclude: [b.yaml]\nobjects: []\n");
  REQUIRE(!newer.errors.empty());
  CHECK(newer.errors[0].slug == "version-too-new");
  CHECK(newer.errors[0].file == "b.yaml");
}

TEST_CASE("what is named may be no pipe, no folder and no loop of links") {
  const Folder folder;
  REQUIRE(::mkfifo((folder.path / "pipe").c_str(), 0600) == 0);
  fs::create_symlink("loop2", folder.path / "loop1");
  fs::create_symlink("loop1", folder.path / "loop2");
  const auto slug = [&](const std::string& name) {
    const Loaded loaded = folder.load(fmt::format("patchlight: 1\ninclude: [{}]\nobjects: []\n", name));
    return loaded.errors.empty() ? std::string{} : loaded.errors[0].slug;
  };
  CHECK(slug("pipe") == "not-a-regular-file");
  CHECK(slug("parts") == "not-a-regular-file");
  CHECK(slug("''") == "not-a-regular-file");
  CHECK(slug("loop1") == "include-not-found");
  CHECK(slug(std::string(5000, 'x')) == "include-not-found");
  CHECK(slug("\"b\\0.yaml\"") == "control-character");
  CHECK(slug("[b.yaml]") == "expected-text");
  CHECK(slug("~") == "null-value");
}

TEST_CASE("an include may have 16 levels and 256 files; objects may all stand in it") {
  const Folder folder;
  folder.write("b.yaml", "materials: {m: {emission: 1}}\nobjects: [{quad: {size: [1, 1]}, material: m}]\n");
  CHECK(folder.load("patchlight: 1\ninclude: [b.yaml]\n").errors.empty());
  for (int k = 1; k <= 17; ++k)
    folder.write(fmt::format("d{}.yaml", k),
                 k < 17 ? fmt::format("include: [d{}.yaml]\n", k + 1) : "let: {a: 1}\n");
  const Loaded deep = folder.load("patchlight: 1\ninclude: [b.yaml, d1.yaml]\n");
  REQUIRE(deep.errors.size() == 1);
  CHECK(deep.errors[0].slug == "too-many-includes");
  CHECK(deep.errors[0].file == "d16.yaml");
  folder.write("d16.yaml", "let: {a: 1}\n");
  CHECK(folder.load("patchlight: 1\ninclude: [b.yaml, d1.yaml]\n").errors.empty());
}

}  // namespace
}  // namespace patchlight::test
