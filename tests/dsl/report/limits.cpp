// Limits: each is held at its border, its message names number and flag, and nothing is expanded beyond it.
#include "dsl/report/limits.h"

#include "tests/dsl/support.h"
#include "tests/folder.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace patchlight::test {
namespace {

using testing::Folder;

const std::string kShort = "patchlight: 1\nmaterials: {lamp: {emission: 1}}\nobjects:\n";
const std::string kQuad = "quad: {size: [1,1]}, material: lamp";

// A scene of one object.
std::string scene_of(const std::string& shape) { return kShort + "  - {id: a, " + shape + "}\n"; }

std::string polygon_of(const std::string& holes) {
  return kShort + "  - {polygon: [[0,0,0],[0,0,1],[1,0,1],[1,0,0]], material: lamp" + holes + "}\n";
}

struct Border {
  const char* name;
  uint64_t Limits::*limit;
  uint64_t enough;  // loads with this limit, not with one less
  std::string text;
  const char* slug;
  int exit;
};

const std::vector<Border> kBorders = {
    {"bytes", &Limits::scene_bytes, scene_of(kQuad).size(), scene_of(kQuad), "file-too-large", 5},
    {"levels in brackets", &Limits::nesting, 5, scene_of(kQuad), "too-deep", 3},
    {"levels in indents", &Limits::nesting, 5,
     "patchlight: 1\nmaterials:\n  lamp:\n    emission: 1\nobjects:\n- quad:\n    size:\n    - 1\n    - 1\n"
     "  material: lamp\n",
     "too-deep", 3},
    {"values", &Limits::values, 22, scene_of(kQuad), "memory-limit", 5},
    {"alias values", &Limits::alias_values, 9, kShort + "  - group: [&q {" + kQuad + "}]\n  - group: [*q]\n",
     "alias-expansion", 3},
    {"polygons of a box", &Limits::polygons, 6, scene_of("box: {size: [1,1,1]}, material: lamp"),
     "too-many-polygons", 5},
    {"polygons of a grid", &Limits::polygons, 6,
     scene_of("grid: {size: [3,2], cells: [3,2]}, material: lamp"), "too-many-polygons", 5},
    {"polygons of a repeat", &Limits::polygons, 6,
     scene_of("repeat: {count: [3,1,2], step: [2,2,2], of: {" + kQuad + "}}"), "too-many-polygons", 5},
    {"polygons of a repeat of repeats", &Limits::polygons, 6,
     scene_of("repeat: {count: 3, step: [2,0,0], of: {repeat: {count: 2, step: [0,2,0], of: {" + kQuad +
              "}}}}"),
     "too-many-polygons", 5},
    {"polygons of a group", &Limits::polygons, 2,
     scene_of("group: [{" + kQuad + "}, {" + kQuad + ", translate: [0,2,0]}]"), "too-many-polygons", 5},
    {"corners", &Limits::corners, 4, polygon_of(""), "too-many-polygons", 5},
    {"corners with those of holes", &Limits::corners, 7,
     polygon_of(", holes: [[[.2,0,.2],[.3,0,.2],[.3,0,.3]]]"), "too-many-polygons", 5},
    {"a picture's side", &Limits::image_side, 30,
     scene_of(kQuad) + "camera: {eye: [0,3,1], target: [0,0,0], size: [20, 30]}\n", "image-too-large", 5},
    {"a picture's pixels", &Limits::image_pixels, 600,
     scene_of(kQuad) + "camera: {eye: [0,3,1], target: [0,0,0], size: [20, 30]}\n", "image-too-large", 5},
    {"an expression's length", &Limits::expression_characters, 6,
     scene_of("quad: {size: ['=1+2+3',1]}, material: lamp"), "expression-too-long", 3},
    {"an expression's depth", &Limits::expression_depth, 3,
     scene_of("quad: {size: ['=((1))',1]}, material: lamp"), "expression-too-long", 3},
};

TEST_CASE("each limit is held at its border, and its message names what it is and what raises it") {
  for (const Border& row : kBorders) {
    CAPTURE(row.name);
    Limits limits;
    limits.*row.limit = row.enough;
    const Loaded enough = load(row.text, limits);
    if (!enough.errors.empty()) FAIL_CHECK(enough.errors[0].message);
    --(limits.*row.limit);
    const Loaded less = load(row.text, limits);
    REQUIRE(less.errors.size() == 1);
    const Diagnostic& error = less.errors[0];
    CHECK(error.slug == row.slug);
    CHECK(exit_code(error) == row.exit);
    CHECK_MESSAGE(error.message.find(limit_text(limits, row.limit)) != std::string::npos, error.message);
  }
}

TEST_CASE("a limit reads as a number, its unit and its flag") {
  Limits limits;
  CHECK(limit_text(limits, &Limits::scene_bytes) == "32 MiB (--max-scene-bytes raises it)");
  CHECK(limit_text(limits, &Limits::polygons) == "1000000 polygons (--max-polygons raises it)");
  limits.mesh_bytes = 1000;
  CHECK(limit_text(limits, &Limits::mesh_bytes) == "1000 bytes (--max-mesh-bytes raises it)");
  CHECK(find_image_fault(limits, 16'384, 3906).empty());
  CHECK(find_image_fault(limits, 16'385, 1) ==
        "a picture of 16385 x 1 is above the limit of 16384 pixels a side (--max-side raises it)");
  CHECK(find_image_fault(limits, 1ull << 33, 1ull << 33).find("--max-side") != std::string::npos);
  CHECK(find_image_fault(limits, 16'384, 3907).find("64000000 pixels (--max-pixels") != std::string::npos);
}

// Loads a scene that lies in a folder.
Loaded load_file(const Folder& folder, const std::string& text, const Limits& limits) {
  testing::write_bytes(folder / "scene.yaml", text);
  Loaded loaded;
  try {
    loaded.scene = load_scene(folder / "scene.yaml", loaded.warnings, {{}, {}, limits});
  } catch (const UserError& error) {
    loaded.errors = error.diagnostics;
  }
  return loaded;
}

void check_border(const Folder& folder, const std::string& text, uint64_t Limits::*limit, uint64_t enough,
                  const char* slug) {
  Limits limits;
  limits.*limit = enough;
  CHECK(load_file(folder, text, limits).errors.empty());
  --(limits.*limit);
  const Loaded less = load_file(folder, text, limits);
  REQUIRE(less.errors.size() == 1);
  CHECK(less.errors[0].slug == slug);
  CHECK(exit_code(less.errors[0]) == 5);
  CHECK(less.errors[0].message.find(limit_text(limits, limit)) != std::string::npos);
}

TEST_CASE("the bytes of a scene are those of all its files, its includes are counted, and their depth is") {
  const Folder folder;
  const std::string text = scene_of(kQuad) + "include: [a.yaml, b.yaml]\n";
  const std::string a = "materials: {m: {reflectance: 0}}\n", b = "include: [c.yaml]\n", c = "let: {w: 1}\n";
  testing::write_bytes(folder / "a.yaml", a);
  testing::write_bytes(folder / "b.yaml", b);
  testing::write_bytes(folder / "c.yaml", c);
  check_border(folder, text, &Limits::scene_bytes, text.size() + a.size() + b.size() + c.size(),
               "file-too-large");
  check_border(folder, text, &Limits::includes, 3, "too-many-includes");
  check_border(folder, text, &Limits::include_depth, 2, "too-many-includes");
}

TEST_CASE("the bytes of meshes are those of all OBJ and MTL files, their faces are polygons") {
  const Folder folder;
  const std::string obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\nfo 3 2 1\n";
  const std::string mtl = "newmtl a\nKd 0.5\n", copy = obj + "# a copy\n";
  testing::write_bytes(folder / "m.obj", obj);
  testing::write_bytes(folder / "copy.obj", copy);
  testing::write_bytes(folder / "m.mtl", mtl);
  const std::string text = scene_of(kQuad) + "  - {mesh: m.obj}\n  - {mesh: copy.obj, translate: [0,0,1]}\n" +
                           "  - {mesh: m.obj, translate: [0,0,2]}\n";
  // The copy reads the MTL file again.
  check_border(folder, text, &Limits::mesh_bytes, obj.size() + copy.size() + 2 * mtl.size(),
               "file-too-large");
  check_border(folder, scene_of(kQuad), &Limits::polygons, 1, "too-many-polygons");
  const std::string two = kShort + "  - {mesh: m.obj}\n";
  check_border(folder, two, &Limits::polygons, 2, "too-many-polygons");
  const std::string copies = kShort + "  - {repeat: {count: 3, step: [2,0,0], of: {mesh: m.obj}}}\n";
  check_border(folder, copies, &Limits::polygons, 6, "too-many-polygons");
}

TEST_CASE("vertices and corners of a mesh are bounded by the polygons that they might be") {
  const Folder folder;
  std::string obj, many;
  for (int k = 0; k < 17; ++k) many += fmt::format("v {} 0 0\n", k);
  for (int k = 0; k < 16; ++k) {
    const double angle = k * std::numbers::pi / 8;
    obj += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
  }
  obj += "f 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n";
  testing::write_bytes(folder / "m.obj", obj);
  testing::write_bytes(folder / "many.obj", many + "f 1 2 3\n");
  check_border(folder, kShort + "  - {mesh: m.obj}\n", &Limits::polygons, 2, "too-many-polygons");
  check_border(folder, kShort + "  - {repeat: {count: 3, step: [0,0,1], of: {mesh: m.obj}}}\n",
               &Limits::polygons, 6, "too-many-polygons");
  Limits limits;
  limits.polygons = 2;
  const Loaded loaded = load_file(folder, kShort + "  - {mesh: many.obj}\n", limits);
  REQUIRE(loaded.errors.size() == 1);
  CHECK(loaded.errors[0].slug == "too-many-polygons");
  CHECK(loaded.errors[0].file == "many.obj");
  CHECK(loaded.errors[0].line == 18);
}

TEST_CASE("a number of copies that no integer holds is refused, not wrapped") {
  // 2^32 * 2^32 is 0 and 2^33 * 2^33 * 2 is 0, both modulo 2^64.
  for (const char* count :
       {"[4294967296, 4294967296, 1]", "[8589934592, 8589934592, 2]", "[1000000, 1, 2]"}) {
    const Loaded loaded =
        load(scene_of(fmt::format("repeat: {{count: {}, step: [1,1,1], of: {{{}}}}}", count, kQuad)));
    REQUIRE(loaded.errors.size() == 1);
    CHECK(loaded.errors[0].slug == "too-many-polygons");
  }
  const Loaded grid = load(scene_of("grid: {size: [1,1], cells: [1000000000, 1000000000]}, material: lamp"));
  REQUIRE(grid.errors.size() == 1);
  CHECK(grid.errors[0].slug == "too-many-polygons");
}

TEST_CASE("copies are bounded by what they read, objects and corners by the polygons that they might be") {
  Limits limits;
  limits.polygons = 100;  // 6400 values read by repeats, 400 objects, 800 corners
  const auto slug_of = [&](const std::string& shape) {
    const Loaded loaded = load(scene_of(shape), limits);
    return loaded.errors.empty() ? std::string{} : loaded.errors[0].slug + ": " + loaded.errors[0].message;
  };
  // Nine values with one quad, and the list of steps 11 * n + 2.
  std::string steps;
  for (int k = 0; k < 20; ++k) steps += "{translate: [0,0,1]},";
  const std::string copy = "{" + kQuad + ", transform: [" + steps + "]}";
  CHECK(slug_of("repeat: {count: 40, step: [2,0,0], of: " + copy + "}").empty());
  CHECK(slug_of("repeat: {count: 60, step: [2,0,0], of: " + copy + "}").find("values each") !=
        std::string::npos);
  // Two that are allowed alone.
  CHECK(slug_of("group: [{repeat: {count: 40, step: [2,0,0], of: " + copy +
                "}}, {repeat: {count: 40, step: "
                "[2,0,0], of: " +
                copy + "}, translate: [0,5,0]}]")
            .find("values each") != std::string::npos);
  const std::string nothing = "{repeat: {count: 95, step: [1,0,0], of: {group: []}}}";
  CHECK(slug_of("group: [" + nothing + ", {" + kQuad + "}]").empty());
  CHECK(slug_of("group: [" + nothing + "," + nothing + "," + nothing + "," + nothing + "," + nothing + "]")
            .find("number of objects") != std::string::npos);
  CHECK(slug_of("repeat: {count: 8, step: [0,1,0], of: {disk: {radius: 1, sides: 100}, material: lamp}}")
            .empty());
  CHECK(slug_of("repeat: {count: 9, step: [0,1,0], of: {disk: {radius: 1, sides: 100}, material: lamp}}")
            .find("number of corners") != std::string::npos);
}

TEST_CASE("faces are counted while polygons are cut: each is a patch to start with") {
  // A strip of 1:1000 is cut into 1000 squares.
  const auto strips = [](int count) {
    return scene_of(fmt::format(
        "repeat: {{count: {}, step: [0,1,0], of: {{quad: {{size: [1000,1]}}, material: white}}}}", count));
  };
  std::string text = strips(3);
  text.replace(text.find("lamp: {emission: 1}"), 19, "white: {reflectance: 0.5}");
  Limits limits;
  limits.starting_patches = 3000;
  CHECK(load(text + "solver: {max_patches: 1}\n", limits).scene.faces.size() == 3000);
  limits.starting_patches = 2999;
  const Loaded less = load(text + "solver: {max_patches: 1}\n", limits);
  REQUIRE(less.errors.size() == 1);
  CHECK(less.errors[0].slug == "too-many-patches");
  CHECK(less.errors[0].message ==
        "'a[2]' takes the scene above the limit of 2999 starting patches (--max-patches raises it)");
  CHECK(load(text + "solver: {max_patches: 3000}\n", limits).errors.empty());
  const Loaded both = load(text + "solver: {max_patches: 3000}\n  ", limits);
  CHECK(both.errors.empty());
  text.replace(text.find("material: white}"), 16, "material: white, two_sided: true}");
  CHECK(load(text + "solver: {max_patches: 5999}\n", limits).errors[0].slug == "too-many-patches");
  CHECK(load(text + "solver: {max_patches: 6000}\n", limits).errors.empty());
}

TEST_CASE("what subdivide asks for is counted before it is made") {
  const auto with = [](const char* more) {
    return load(scene_of("polygon: [[0,0,0],[0,0,1],[1,0,1],[1,0,0]], material: lamp, subdivide: 2000") +
                more);
  };
  const Loaded loaded = with("");  // 2048 * 2048 patches
  REQUIRE(loaded.errors.size() == 1);
  CHECK(loaded.errors[0].slug == "too-many-patches");
  CHECK(loaded.errors[0].message.find("--max-patches raises it") != std::string::npos);
  CHECK(with("solver: {max_patches: 4194304}\n").errors.empty());
  CHECK(with("solver: {max_patches: 4194303}\n").errors.size() == 1);
}

TEST_CASE("of very many errors or warnings, 20 of a kind are kept") {
  std::string numbers = kShort, repeated = kShort;
  for (int k = 0; k < 30; ++k) {
    numbers += "  - {material: lamp, polygon: [";
    for (int j = 0; j < 1000; ++j) numbers += "[a,b,c],";
    numbers += "]}\n";
  }
  repeated += "  - {material: lamp, polygon: [[0,0,0],[0,0,1],[1,0,1]";
  for (int k = 0; k < 9000; ++k) repeated += ",[1,0,1]";
  const Loaded errors = load(numbers);
  CHECK(errors.errors.size() == kErrorsShown);
  CHECK(errors.more == 90'000 - kErrorsShown);
  const Loaded warnings = load(repeated + "]}\n");
  REQUIRE(warnings.errors.empty());
  REQUIRE(warnings.warnings.size() == kWarningsShown + 1);
  CHECK(warnings.warnings[0].line == 4);
  CHECK(warnings.warnings[1].column == warnings.warnings[0].column + 8);
  CHECK(warnings.warnings.back().message == "and 8980 more of these");
}

TEST_CASE("expectations may not name the polygons of a scene again and again") {
  Limits limits;
  limits.polygons = 6;
  std::string text = scene_of("box: {size: [1,1,1]}, material: lamp") + "expect:\n";
  for (int k = 0; k < 8; ++k) text += "  - {object: a, radiosity: 1}\n";
  const Loaded enough = load(text, limits);
  REQUIRE(enough.errors.empty());
  CHECK(enough.scene.expectations[7].polygons == std::vector<uint32_t>{0, 1, 2, 3, 4, 5});
  const Loaded more = load(text + "  - {object: a.floor, radiosity: 1}\n", limits);
  REQUIRE(more.errors.size() == 1);
  CHECK(more.errors[0].slug == "too-many-polygons");
}

}  // namespace
}  // namespace patchlight::test
