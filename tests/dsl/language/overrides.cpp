// Values of the command line in the tree.
#include "dsl/language/overrides.h"

#include "tests/dsl/support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

Loaded load_set(const std::string& text, const std::vector<std::string>& overrides) {
  Loaded loaded;
  try {
    loaded.scene = load_scene_text(text, "t.yaml", loaded.warnings, {{}, overrides});
  } catch (const UserError& error) {
    loaded.errors = error.diagnostics;
  }
  return loaded;
}

TEST_CASE("values are replaced, and added where they were absent") {
  const Loaded loaded = load_set(
      kBase + "solver: {passes: 2}\n",
      {"solver.passes=4", "solver.rays=64", "output.shading=flat", "materials.lamp.emission=[1, 2, 3]",
       "objects.floor.two_sided=true", "objects.1.id=sun", "title=x y"});
  REQUIRE(loaded.errors.empty());
  const Scene& scene = loaded.scene;
  CHECK(scene.solver.pass_count_max == 4);
  CHECK(scene.solver.rays == 64);
  CHECK(scene.output.shading == Shading::kFlat);
  CHECK(scene.title == "x y");
  CHECK(scene.polygons.id == std::vector<std::string>{"floor", "floor.back", "sun"});
  CHECK(scene.faces.emission.back() == Rgb(1, 2, 3));
}

TEST_CASE("a wrong value is told at the option, a wrong path as usage") {
  const Loaded value = load_set(kBase, {"solver.passes=x"});
  REQUIRE(value.errors.size() == 1);
  CHECK(value.errors[0].slug == "expected-integer");
  CHECK(value.errors[0].file == "--set solver.passes");
  for (const char* text :
       {"solver.passes", "=1", "a..b=1", "objects.nosuch.id=a", "title.x=1", "solver.passes="}) {
    CAPTURE(text);
    const Loaded path = load_set(kBase + "title: t\n", {text});
    REQUIRE(!path.errors.empty());
    CHECK(path.errors[0].slug == "usage");
    CHECK(exit_code(path.errors[0]) == 2);
  }
  const Loaded yaml = load_set(kBase, {"solver=[1"});
  REQUIRE(yaml.errors.size() == 1);
  CHECK(yaml.errors[0].slug == "yaml-syntax");
}

TEST_CASE("a path that leads nowhere is told what was probably meant") {
  const auto said = [](const char* text) {
    const Loaded loaded = load_set(kBase + "title: t\n", {text});
    REQUIRE(!loaded.errors.empty());
    return loaded.errors[0].message;
  };
  CHECK(said("objects.lihgt.material=white") ==
        "--set objects.lihgt.material=white: the list of 2 there has no 'lihgt': items go by number, from 0, "
        "or by id; "
        "did you mean 'light'?");
  CHECK(said("objects.7.material=white").find("has no '7'") != std::string::npos);
  CHECK(said("objects.light=white").find("name one of its keys") != std::string::npos);
  CHECK(said("title.x=1").find("'x' is looked for in the text 't', which has no parts") != std::string::npos);
  CHECK(said("solver.pases=3") == "unknown key 'pases' in solver; did you mean 'passes'?");
  CHECK(said("slover.passes=3") == "unknown key 'slover' in scene; did you mean 'solver'?");
}

}  // namespace
}  // namespace patchlight::test
