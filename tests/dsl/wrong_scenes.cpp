// Wrong and borderline scenes: what each is told, and where.
#include "support.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

struct Wrong {
  const char* name;
  std::string text;
  const char* slug;
  int line, column;
  int exit;
};

// The first message of each, and the exit code that belongs to it.
const std::vector<Wrong> kWrong = {
    {"unclosed flow seq", kBase + "x: [1, 2\n", "yaml-syntax", 8, 4, 3},
    {"unterminated dquote eof", kBase + "title: \"abc\nsolver: {passes: 16}\n", "yaml-unterminated-string", 8,
     8, 3},
    {"tab indent", "patchlight: 1\nmaterials:\n\twhite: {reflectance: 0.5}\n", "yaml-tab-indent", 3, 1, 3},
    {"bad dedent", "patchlight: 1\nmaterials:\n    a: {reflectance: 0.5}\n  b: {reflectance: 0.5}\n",
     "yaml-syntax", 4, 3, 3},
    {"missing space after colon", kBase + "units:cm\nsolver: {passes: 2}\n", "yaml-syntax", 8, 1, 3},
    {"trailing comma hole",
     kHead + kLight + "  - {id: p, polygon: [[0,0,0],,[1,0,0],[1,0,1]], material: white}\n", "null-value", 7,
     31, 3},
    {"missing comma in vector",
     kHead + kLight + "  - {id: p, polygon: [[0 0 0],[1,0,0],[1,0,1]], material: white}\n", "expected-vec3",
     7, 23, 3},
    {"alias cycle map", kBase + "let: &a\n  b: *a\n", "alias-cycle", 9, 6, 3},
    {"custom tag", kBase + "solver: !python/object:os.system {passes: 1}\n", "unknown-tag", 8, 9, 3},
    {"unknown tag float",
     kHead + kLight + "  - {id: p, polygon: [[!!float abc,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expected-number", 7, 24, 3},
    {"complex key", kBase + "? [1, 2]\n: 3\n", "key-not-string", 8, 3, 3},
    {"trailing garbage comma", "\"patchlight\", 1\n", "yaml-syntax", 1, 13, 3},
    {"yaml directive 2", std::string("%YAML 2.0\n---\n") + kBase, "yaml-syntax", 1, 1, 3},
    {"bad escape", kBase + "title: \"\\q\"\n", "yaml-syntax", 8, 10, 3},
    {"empty file", "", "empty-scene", 1, 1, 3},
    {"only comment", "# nothing here\n", "empty-scene", 1, 1, 3},
    {"seq root", "- a\n- b\n", "root-not-map", 1, 1, 3},
    {"unknown top key", kBase + "camrea: {}\n", "unknown-key", 8, 1, 3},
    {"wrong case key", kBase + "Solver: {passes: 2}\n", "unknown-key", 8, 1, 3},
    {"duplicate key", kBase + "solver: {passes: 1}\nsolver: {passes: 16}\n", "duplicate-key", 9, 1, 3},
    {"duplicate object id", kBase + "  - {id: floor, polygon: [[0,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "duplicate-id", 8, 10, 3},
    {"empty objects", "patchlight: 1\nmaterials: {}\nobjects: []\n", "empty-scene", 3, 10, 3},
    {"objects is map", "patchlight: 1\nobjects: {a: 1}\n", "expected-list", 2, 10, 3},
    {"material undefined", kHead + kLight + "  - {polygon: [[0,0,0],[1,0,0],[1,0,1]], material: whte}\n",
     "unknown-material", 7, 52, 3},
    {"two shapes in object", kHead + kLight + "  - {quad: {}, box: {}, material: white}\n", "ambiguous-shape",
     7, 5, 3},
    {"version missing",
     std::string("materials:\n  white: {reflectance: [0.73, 0.73, 0.73]}\n  lamp: {reflectance: 0.0, "
                 "emission: [15, 15, 12]}\nobjects:\n") +
         kFloor + kLight,
     "missing-version", 1, 1, 3},
    {"version string",
     std::string("patchlight: one\nmaterials:\n  white: {reflectance: [0.73, 0.73, 0.73]}\n  lamp: "
                 "{reflectance: 0.0, emission: [15, 15, 12]}\nobjects:\n") +
         kFloor + kLight,
     "expected-integer", 1, 13, 3},
    {"vec4", kHead + kLight + "  - {id: p, polygon: [[0,0,0,1],[1,0,0,1],[1,0,1,1]], material: white}\n",
     "expected-vec3", 7, 23, 3},
    {"bool as number",
     kHead + kLight + "  - {id: p, polygon: [[true,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expected-number", 7, 24, 3},
    {"string number",
     kHead + kLight + "  - {id: p, polygon: [[\"0\",0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expected-number", 7, 24, 3},
    {"coord inf", kHead + kLight + "  - {id: p, polygon: [[.inf,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "non-finite", 7, 24, 3},
    {"coord ninf", kHead + kLight + "  - {id: p, polygon: [[-.inf,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "non-finite", 7, 24, 3},
    {"coord 1e309", kHead + kLight + "  - {id: p, polygon: [[1e309,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "number-out-of-range", 7, 24, 3},
    {"coord hex", kHead + kLight + "  - {id: p, polygon: [[0x10,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expected-number", 7, 24, 3},
    {"coord underscore",
     kHead + kLight + "  - {id: p, polygon: [[1_000,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expected-number", 7, 24, 3},
    {"coord text", kHead + kLight + "  - {id: p, polygon: [[abc,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expected-number", 7, 24, 3},
    {"coord null", kHead + kLight + "  - {id: p, polygon: [[~,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "null-value", 7, 24, 3},
    {"coord percent", kHead + kLight + "  - {id: p, polygon: [[5%,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expected-number", 7, 24, 3},
    {"coord 400 digit",
     kHead + kLight + "  - {id: p, polygon: [[1" + std::string(400, '0') +
         ",0,0],[1,0,0],[1,0,1]], material: white}\n",
     "number-out-of-range", 7, 24, 3},
    {"coord expr div zero",
     kHead + kLight + "  - {id: p, polygon: [[\"=1/0\",0,0],[1,0,0],[1,0,1]], material: white}\n",
     "non-finite", 7, 24, 3},
    {"float passes", kBase + "solver: {passes: 2.5}\n", "expected-integer", 8, 18, 3},
    {"zero passes", kBase + "solver: {passes: 0}\n", "out-of-range", 8, 18, 3},
    {"huge passes", kBase + "solver: {passes: 99999999999999999999}\n", "number-out-of-range", 8, 18, 3},
    {"snapshot dup unsorted", kBase + "output: {snapshots: [16, 1, 1, -2]}\n", "out-of-range", 8, 32, 3},
    {"zero vertices", kHead + kLight + "  - {id: p, polygon: [], material: white}\n", "too-few-vertices", 7,
     22, 3},
    {"collinear", kHead + kLight + "  - {id: p, polygon: [[0,0,0],[1,0,0],[2,0,0]], material: white}\n",
     "zero-area", 7, 22, 3},
    {"non planar quad",
     kHead + kLight + "  - {id: p, polygon: [[0,0,0],[1,0,0],[1,0.5,1],[0,0,1]], material: white}\n",
     "non-planar", 7, 39, 3},
    {"spike",
     kHead + kLight + "  - {id: p, polygon: [[0,0,0],[1,0,0],[2,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "self-intersecting", 7, 39, 3},
    {"hole off plane",
     kHead + kLight +
         "  - {id: p, polygon: [[0,0,0],[1,0,0],[1,0,1],[0,0,1]], material: white, holes: "
         "[[[.2,.5,.2],[.3,.5,.2],[.3,.5,.3]]]}\n",
     "non-planar", 7, 82, 3},
    {"hole touches edge",
     kHead + kLight +
         "  - {id: p, polygon: [[0,0,0],[1,0,0],[1,0,1],[0,0,1]], material: white, holes: "
         "[[[0,0,.2],[.3,0,.2],[.3,0,.3]]]}\n",
     "hole-touches", 7, 82, 3},
    {"scale zero", kHead + kLight + "  - {group: [{quad: {size: [1,1]}, material: white}], scale: [1,0,1]}\n",
     "singular-transform", 7, 62, 3},
    {"quad negative size", kHead + kLight + "  - {quad: {size: [-1,1]}, material: white}\n", "out-of-range",
     7, 20, 3},
    {"camera eye equals target", kBase + "camera: {eye: [0,0,0], target: [0,0,0]}\n", "degenerate-camera", 8,
     9, 3},
    {"camera up parallel", kBase + "camera: {eye: [0,5,0], target: [0,0,0], up: [0,1,0]}\n",
     "degenerate-camera", 8, 45, 3},
    {"refl above 1",
     "patchlight: 1\nmaterials:\n  w: {reflectance: 1.2}\nobjects:\n  - {polygon: [[0,0,0],[1,0,0],[1,0,1]], "
     "material: w}\n",
     "reflectance-range", 3, 20, 3},
    {"refl 255",
     "patchlight: 1\nmaterials:\n  w: {reflectance: [255,128,0]}\nobjects:\n  - {polygon: "
     "[[0,0,0],[1,0,0],[1,0,1]], material: w}\n",
     "reflectance-range", 3, 21, 3},
    {"refl nan",
     "patchlight: 1\nmaterials:\n  w: {reflectance: .nan}\nobjects:\n  - {polygon: "
     "[[0,0,0],[1,0,0],[1,0,1]], material: w}\n",
     "non-finite", 3, 20, 3},
    {"refl string",
     "patchlight: 1\nmaterials:\n  w: {reflectance: red}\nobjects:\n  - {polygon: [[0,0,0],[1,0,0],[1,0,1]], "
     "material: w}\n",
     "expected-rgb", 3, 20, 3},
    {"emission huge",
     std::string("patchlight: 1\nmaterials:\n  white: {reflectance: [0.73, 0.73, 0.73]}\n  lamp: "
                 "{reflectance: 0.0, emission: [1e30, 1e30, 1e30]}\nobjects:\n") +
         kFloor + kLight,
     "emission-range", 4, 39, 3},
    {"nested repeat bomb",
     kHead + kLight +
         "  - repeat: {count: 1000, step: [1,0,0], of: {repeat: {count: 1000, step: [0,1,0], of: {repeat: "
         "{count: 1000, step: [0,0,1], of: {quad: {size: [1,1]}, material: white}}}}}}\n",
     "too-many-polygons", 7, 105, 5},
    {"repeat overflow",
     kHead + kLight +
         "  - repeat: {count: [4294967296,4294967296,2], step: [1,1,1], of: {quad: {size: [1,1]}, material: "
         "white}}\n",
     "too-many-polygons", 7, 21, 5},
    {"subdivide 65536",
     kHead +
         "  - {id: floor, polygon: [[0,0,0],[0,0,1],[1,0,1],[1,0,0]], material: white, subdivide: 65536}\n" +
         kLight,
     "too-many-patches", 6, 89, 5},
    {"image 1e6 square", kBase + "camera: {eye: [0,0,3], target: [0,0,0], size: [1000000, 1000000]}\n",
     "image-too-large", 8, 47, 5},
    {"image negative", kBase + "camera: {eye: [0,0,3], target: [0,0,0], size: [-640, 480]}\n", "out-of-range",
     8, 48, 3},
    {"include missing", kBase + "include: [nope.yaml]\n", "include-not-found", 8, 11, 4},
    {"include absolute", kBase + "include: [/etc/passwd]\n", "include-outside-root", 8, 11, 3},
    {"include url", kBase + "include: ['http://example.invalid/x.yaml']\n", "include-not-found", 8, 11, 4},
    {"output name escape", kBase + "output: {basename: '../../tmp/evil'}\n", "output-outside-dir", 8, 20, 3},
    {"title csv formula",
     kHead + kLight + "  - {id: '=HYPERLINK(1)', polygon: [[0,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "bad-id", 7, 10, 3},
    {"undefined variable",
     kHead + kLight + "  - {id: p, polygon: [[$w,0,0],[1,0,0],[1,0,1]], material: white}\n",
     "undefined-variable", 7, 24, 3},
    {"expr syntax",
     kHead + kLight + "  - {id: p, polygon: [[\"=1+\",0,0],[1,0,0],[1,0,1]], material: white}\n",
     "expression-syntax", 7, 28, 3},
    {"expr huge pow",
     kHead + kLight + "  - {id: p, polygon: [[\"=10^10^10\",0,0],[1,0,0],[1,0,1]], material: white}\n",
     "non-finite", 7, 24, 3},
    {"repeat zero",
     kHead + kLight + "  - repeat: {count: 0, step: [1,0,0], of: {quad: {size: [1,1]}, material: white}}\n",
     "out-of-range", 7, 21, 3},
    {"overlong utf8", kBase + "title: \xc0\xaf\n", "not-utf8", 8, 8, 3},
    {"latin 1", kBase + "title: caf\xe9\n", "not-utf8", 8, 11, 3},
    {"utf16",
     std::string("\xff\xfe"
                 "p\0a\0t\0",
                 8),
     "not-utf8", 1, 1, 3},
    {"utf16 without mark", std::string("p\0a\0t\0c\0", 8), "not-utf8", 1, 1, 3},
    {"zero byte", kBase + std::string("title: a\0b\n", 11), "control-character", 8, 9, 3},
    {"escape character in a key", kBase + "\"\x1b[31mkey\": 1\n", "unknown-key", 8, 1, 3},
    {"escape character in a title", kBase + "title: \"\x1b[31m\"\n", "control-character", 8, 8, 3},
    {"100 000 brackets", kBase + "x: " + std::string(100000, '[') + std::string(100000, ']') + "\n",
     "too-deep", 8, 68, 3},
    {"480 brackets", kBase + "x: " + std::string(480, '[') + std::string(480, ']') + "\n", "too-deep", 8, 68,
     3},
    {"key of a million characters", kBase + std::string(1000000, 'x') + ": 1\n", "unknown-key", 8, 1, 3},
    {"second document", kBase + "---\nb: 1\n", "multiple-documents", 8, 1, 3},
    {"merge key", kBase + "solver: {<<: {passes: 1}}\n", "merge-key-unsupported", 8, 10, 3},
    {"undefined alias", kBase + "solver: *nosuch\n", "yaml-undefined-alias", 8, 9, 3},
    {"dollar brace in brackets",
     kHead + kLight + "  - {polygon: [[${w},0,0],[1,0,0],[1,0,1]], material: white}\n", "yaml-syntax", 7, 17,
     3},
    {"leading zero", kBase + "solver: {passes: 010}\n", "ambiguous-integer", 8, 18, 3},
    {"new version", "patchlight: 2\n" + kBase.substr(14), "version-too-new", 1, 13, 3},
    {"unit", kBase + "units: km\n", "bad-unit", 8, 8, 3},
    {"snapshot beyond passes", kBase + "solver: {passes: 4}\noutput: {snapshots: [1, 5]}\n",
     "snapshot-beyond-passes", 9, 25, 3},
    {"two corners", kHead + kLight + "  - {polygon: [[0,0,0],[1,0,0]], material: white}\n",
     "too-few-vertices", 7, 15, 3},
    {"bow tie", kHead + kLight + "  - {polygon: [[0,0,0],[1,1,0],[1,0,0],[0,1,0]], material: white}\n",
     "self-intersecting", 7, 15, 3},
    {"hole outside",
     kHead + kLight +
         "  - {polygon: [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], holes: [[[2,0,0],[3,0,0],[3,1,0]]], material: "
         "white}\n",
     "hole-outside", 7, 58, 3},
    {"hole across the edge",
     kHead + kLight +
         "  - {polygon: [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], holes: [[[.5,.5,0],[2,.5,0],[.5,.7,0]]], "
         "material: white}\n",
     "hole-outside", 7, 58, 3},
    {"holes overlap",
     kHead + kLight +
         "  - {polygon: [[0,0,0],[4,0,0],[4,4,0],[0,4,0]], holes: "
         "[[[1,1,0],[3,1,0],[3,3,0],[1,3,0]],[[1.5,1.5,0],[2,1.5,0],[2,2,0]]], material: white}\n",
     "holes-overlap", 7, 92, 3},
    {"far corner", kHead + kLight + "  - {polygon: [[0,0,0],[1e16,0,0],[0,1,0]], material: white}\n",
     "coordinate-too-large", 7, 24, 3},
    {"null normal", kHead + kLight + "  - {quad: {size: [1,1], normal: [0,0,0]}, material: white}\n",
     "zero-axis", 7, 34, 3},
    {"quad both ways", kHead + kLight + "  - {quad: {size: [1,1], origin: [0,0,0]}, material: white}\n",
     "ambiguous-shape", 7, 34, 3},
    {"expression ends too early", kHead + kLight + "  - {quad: {size: [1, '=(1+2']}, material: white}\n",
     "expression-syntax", 7, 29, 3},
    {"unknown function", kHead + kLight + "  - {quad: {size: [1, '=w/2']}, material: white}\n",
     "expression-syntax", 7, 25, 3},
    {"text behind a name", kHead + kLight + "  - {quad: {size: [1, $w/2]}, material: white}\nlet: {w: 1}\n",
     "expression-syntax", 7, 25, 3},
    {"index outside of a repeat", kHead + kLight + "  - {quad: {size: [1, '=$i+1']}, material: white}\n",
     "undefined-variable", 7, 25, 3},
    {"variables in a circle", kBase + "let: {a: '=$b', b: '=$a'}\n", "variable-cycle", 8, 10, 3},
    {"long expression",
     kHead + kLight + "  - {quad: {size: [1, '=" + std::string(1000, '1') + "']}, material: white}\n",
     "expression-too-long", 7, 24, 3},
    {"deep expression",
     kHead + kLight + "  - {quad: {size: [1, '=" + std::string(65, '(') + "1" + std::string(65, ')') +
         "']}, material: white}\n",
     "expression-too-long", 7, 89, 3},
    {"variable's name", kBase + "let: {2a: 1}\n", "bad-name", 8, 7, 3},
    {"half a pass", kBase + "let: {n: 2.5}\nsolver: {passes: $n}\n", "expected-integer", 9, 18, 3},
    {"two ways to move",
     kHead + kLight +
         "  - {quad: {size: [1,1]}, material: white, translate: [1,0,0], transform: [{scale: 2}]}\n",
     "ambiguous-shape", 7, 75, 3},
    {"two moves in a step",
     kHead + kLight +
         "  - {quad: {size: [1,1]}, material: white, transform: [{scale: 2, translate: [1,0,0]}]}\n",
     "ambiguous-shape", 7, 64, 3},
    {"axis without length",
     kHead + kLight + "  - {quad: {size: [1,1]}, material: white, rotate: {axis: [0,0,0], angle: 1}}\n",
     "zero-axis", 7, 59, 3},
    {"repeat both ways",
     kHead + kLight +
         "  - repeat: {count: 2, step: [1,0,0], transform: [], of: {quad: {size: [1,1]}, material: white}}\n",
     "ambiguous-shape", 7, 50, 3},
    {"repeat of a repeat is counted before it is made",
     kHead + kLight +
         "  - repeat: {count: 1000000, step: [1,0,0], of: {repeat: {count: 2, step: [0,1,0], of: {quad: "
         "{size: [1,1]}, material: white}}}}\n",
     "too-many-polygons", 7, 66, 5},
    {"grid of a billion",
     kHead + kLight + "  - {grid: {size: [1,1], cells: [100000, 10000]}, material: white}\n",
     "too-many-polygons", 7, 33, 5},
    {"two corners of a prism",
     kHead + kLight + "  - {prism: {base: [[0,0,0],[1,0,0]], height: 1}, material: white}\n",
     "too-few-vertices", 7, 20, 3},
    {"expected object that is not there", kBase + "expect: [{object: flor, radiosity: 1}]\n", "bad-id", 8, 19,
     3},
    {"unknown material of a wall",
     kHead + kLight + "  - {room: {size: [1,1,1], walls: {floor: nosuch}}, material: white}\n",
     "unknown-material", 7, 43, 3},
    {"no material", kHead + kLight + "  - {quad: {size: [1,1]}}\n", "missing-key", 7, 5, 3},
    {"no shape", kHead + kLight + "  - {material: white}\n", "missing-key", 7, 5, 3},
    {"unknown side", kHead + kLight + "  - {room: {size: [1,1,1], omit: [lft]}, material: white}\n",
     "bad-name", 7, 35, 3},
    {"two cameras of a name",
     kBase + "cameras:\n  - {name: a, eye: [0,0,3], target: [0,0,0]}\n  - {name: a, eye: [0,0,4], target: "
             "[0,0,0]}\n",
     "duplicate-id", 10, 5, 3},
};

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
         "  - {id: floor2, polygon: [[0,0,0],[1,0,0],[1,0,1],[0,0,1]], material: white, subdivide: 4}\n" +
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

TEST_CASE("every wrong scene is refused with its slug, at its place") {
  for (const Wrong& row : kWrong) {
    CAPTURE(row.name);
    const Loaded loaded = load(row.text);
    REQUIRE(!loaded.errors.empty());
    const Diagnostic& first = loaded.errors.front();
    CAPTURE(first.message);
    CHECK(first.slug == row.slug);
    CHECK(first.line == row.line);
    CHECK(first.column == row.column);
    CHECK(first.file == "t.yaml");
    CHECK(exit_code(first.slug) == row.exit);
  }
}

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
