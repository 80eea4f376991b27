// Borderline scenes, which load; and what holds for the messages of all wrong ones (wrong_records.cpp).
#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

struct Borderline {
  const char* name;
  std::string text;
  const char* slug;  // of the warning; empty: none
  int line, column;
};

// Scenes that load, and what is warned of.
const std::vector<Borderline> kBorderline = {
    {"denormal", kHead + kLight + "  - {id: p, polygon: [[1e-310,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "", 0, 0},
    {"repeated vertex",
     kHead + kLight + "  - {id: p, polygon: [[0,0,0],[0,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "repeated-vertex", 7, 31},
    {"nearly planar",
     kHead + kLight + "  - {id: p, polygon: [[0,0,0],[1,0,0],[1,1e-7,1],[0,0,1]], material: white}\n", "", 0,
     0},
    {"duplicate polygon coplanar",
     kHead + kFloor +
         "  - {id: floor2, polygon: [[1,0,0],[0,0,0],[0,0,1],[1,0,1]], material: white, subdivide: 4}\n" +
         kLight,
     "coincident", 7, 27},
    {"negative scale", kHead + kLight + "  - {quad: {size: [1,1]}, material: white, scale: [-1,1,1]}\n", "",
     0, 0},
    {"tiny scene 1e 9",
     kHead + kLight + "  - {id: p, polygon: [[0,0,0],[1e-9,0,0],[1e-9,0,1e-9]], material: white}\n", "", 0,
     0},
    {"refl 1",
     "patchlight: 1\nmaterials:\n  w: {reflectance: 1.0}\nobjects:\n  - {polygon: [[0,0,0],[1,0,0],[1,0,1]], "
     "material: w}\n",
     "reflectance-one", 3, 20},
    {"no emitter", kHead + kFloor, "no-emitter", 1, 1},
    {"output name percent s", kBase + "output: {basename: '%s%n%s'}\n", "", 0, 0},
    {"closing corner", kHead + kLight + "  - {polygon: [[0,0,0],[1,0,0],[1,0,1],[0,0,0]], material: white}\n",
     "closed-ring", 7, 40},
    {"a little off plane",
     kHead + kLight + "  - {polygon: [[0,0,0],[1,0,0],[1,0.02,1],[0,0,1]], material: white}\n", "non-planar",
     7, 15},
    {"material that nothing uses", kHead + kLight, "unused-material", 3, 3},
};

TEST_CASE("every borderline scene loads, with its warning where it has one") {
  for (const Borderline& row : kBorderline) {
    CAPTURE(row.name);
    const Loaded loaded = load(row.text);
    REQUIRE(loaded.errors.empty());
    CHECK(loaded.scene.faces.size() > 0);
    if (!*row.slug) continue;
    CHECK(count_slug(loaded.warnings, row.slug) == 1);
    for (const Diagnostic& warning : loaded.warnings)
      if (warning.slug == row.slug) {
        CHECK(warning.line == row.line);
        CHECK(warning.column == row.column);
      }
  }
}

TEST_CASE("line ends of Windows leave lines and columns right") {
  std::string text;
  for (const char c : kBase + "camrea: {}\n") text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const Loaded loaded = load(text);
  REQUIRE(loaded.errors.size() == 1);
  CHECK(loaded.errors[0].line == 8);
  CHECK(loaded.errors[0].column == 1);
  CHECK(loaded.errors[0].source_line == "camrea: {}");
}

TEST_CASE("columns count characters, not bytes") {
  const Loaded loaded = load(kBase + "output: {basename: \"\xc3\xa4\xc3\xb6\", shading: x}\n");
  REQUIRE(!loaded.errors.empty());
  CHECK(loaded.errors[0].slug == "bad-name");
  CHECK(loaded.errors[0].column == 35);
}

TEST_CASE("of many errors 20 are kept and the others counted") {
  std::string text = kHead + kLight;
  for (int k = 0; k < 50000; ++k) text += "  - {bad: 1}\n";
  const Loaded loaded = load(text);
  CHECK(loaded.errors.size() == 20);
  CHECK(loaded.more == 49980);
}

TEST_CASE("several errors of one file come together, in its order") {
  const Loaded loaded = load(kHead +
                             "  - {id: a, quad: {size: [1, x]}, material: white}\n  - {id: b, quad: {size: "
                             "[1, 1]}, material: whte}\nsolver: {passes: 0}\n");
  REQUIRE(loaded.errors.size() == 3);
  CHECK(loaded.errors[0].slug == "expected-number");
  CHECK(loaded.errors[1].slug == "unknown-material");
  CHECK(loaded.errors[2].slug == "out-of-range");
}

}  // namespace
}  // namespace patchlight::test
