// What is legal and probably not meant: flipped walls, rooms turned inside out, polygons in one plane.
#include "tests/dsl/support.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace patchlight::test {
namespace {

constexpr const char* kBulb =
    "  - {id: bulb, quad: {center: [0.5, 0.9, 0.5], size: [0.2, 0.2], normal: [0, -1, 0]}, material: lamp}\n";

// A unit room of polygons, the first `count` of its walls; those of `flipped` have their corners the other
// way round.
std::string room_scene(const std::vector<std::string>& flipped, size_t count = 6,
                       const std::string& rest = kBulb) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> walls = {
      {"floor", {"[0,0,0]", "[0,0,1]", "[1,0,1]", "[1,0,0]"}},
      {"ceiling", {"[0,1,0]", "[1,1,0]", "[1,1,1]", "[0,1,1]"}},
      {"left", {"[0,0,0]", "[0,1,0]", "[0,1,1]", "[0,0,1]"}},
      {"right", {"[1,0,0]", "[1,0,1]", "[1,1,1]", "[1,1,0]"}},
      {"back", {"[0,0,0]", "[1,0,0]", "[1,1,0]", "[0,1,0]"}},
      {"front", {"[0,0,1]", "[0,1,1]", "[1,1,1]", "[1,0,1]"}}};
  std::string text = kHead;
  for (size_t k = 0; k < count; ++k) {
    auto [id, corners] = walls[k];
    if (std::find(flipped.begin(), flipped.end(), id) != flipped.end())
      std::reverse(corners.begin(), corners.end());
    text += "  - {id: " + id + ", polygon: [";
    for (size_t c = 0; c < corners.size(); ++c) text += (c > 0 ? "," : "") + corners[c];
    text += "], material: white}\n";
  }
  return text + rest;
}

// The beginnings of all warnings of one slug, one a line.
std::string said(const std::string& text, std::string_view slug) {
  const Loaded loaded = load(text);
  CHECK(loaded.errors.empty());
  std::string list;
  for (const Diagnostic& warning : loaded.warnings)
    if (warning.slug == slug) list += warning.message.substr(0, warning.message.find(';')) + "\n";
  return list;
}

TEST_CASE("a room whose walls agree is silent, open or closed, mirrored or not") {
  for (const size_t count : {size_t{3}, size_t{5}, size_t{6}})
    CHECK(said(room_scene({}, count), "flipped") == "");
  CHECK(said(kHead + "  - {room: {size: [1, 1, 1]}, material: white, scale: [1, 1, -1]}\n"
                     "  - {quad: {center: [0.5, 0.9, -0.5], size: [0.2, 0.2], normal: [0, -1, 0]}, material: "
                     "lamp}\n",
             "flipped") == "");
}

TEST_CASE("a wall that faces the other way than its neighbours is named, and two are both") {
  CHECK(said(room_scene({"floor"}), "flipped") ==
        "'floor' faces the other way than 'left' and 'right' beside it\n");
  CHECK(said(room_scene({"floor"}, 5), "flipped") ==
        "'floor' faces the other way than 'left' and 'right' beside it\n");
  const std::string two = said(room_scene({"floor", "left"}), "flipped");
  CHECK(std::count(two.begin(), two.end(), '\n') == 2);
  CHECK(two.find("'floor' faces") != std::string::npos);
  CHECK(two.find("'left' faces") != std::string::npos);
  const Loaded loaded = load(room_scene({"floor"}));
  CHECK(loaded.warnings.front().line == 6);
}

TEST_CASE("a wall of its own beside a room's is compared with them, holes and all") {
  const std::string room =
      kHead + "  - {id: r, room: {size: [1, 1, 1], omit: [left]}, material: white}\n" + kBulb;
  const std::string hole = "holes: [[[0,.2,.2],[0,.2,.4],[0,.4,.4],[0,.4,.2]]]";
  CHECK(
      said(room + "  - {id: w, polygon: [[0,0,0],[0,1,0],[0,1,1],[0,0,1]], " + hole + ", material: white}\n",
           "flipped") == "");
  CHECK(
      said(room + "  - {id: w, polygon: [[0,0,0],[0,0,1],[0,1,1],[0,1,0]], " + hole + ", material: white}\n",
           "flipped") == "'w' faces the other way than 'r.floor' and 'r.ceiling' beside it\n");
  // A reveal that joins the hole's lower edge faces up, into the hole's light.
  const std::string sill = "[0,.2,.2],[0,.2,.4],[-.1,.2,.4],[-.1,.2,.2]";
  CHECK(said(room + "  - {id: w, polygon: [[0,0,0],[0,1,0],[0,1,1],[0,0,1]], " + hole +
                 ", material: white}\n  - {polygon: [" + sill + "], material: white}\n",
             "flipped") == "");
}

TEST_CASE("two-sided walls, single neighbours and edges of three polygons are left alone") {
  CHECK(said(room_scene({}, 6,
                        std::string(kBulb) +
                            "  - {polygon: [[0,0,0],[0,0,1],[-1,1,1],[-1,1,0]], material: white}\n"),
             "flipped") == "");
  std::string text = room_scene({"floor"});
  text.insert(text.find("], material") + 1, ", two_sided: true");
  CHECK(said(text, "flipped") == "");
  // Two quads in a V, one turned: either may be meant.
  CHECK(said(kHead + kLight +
                 "  - {polygon: [[0,0,0],[1,0,0],[1,2,1],[0,2,1]], material: white}\n"
                 "  - {polygon: [[0,0,0],[1,0,0],[1,2,-1],[0,2,-1]], material: white}\n",
             "flipped") == "");
}

TEST_CASE("a lamp among the backs of a room that is turned inside out is told once") {
  const std::vector<std::string> all = {"floor", "ceiling", "left", "right", "back", "front"};
  CHECK(said(room_scene(all), "flipped")
            .starts_with(
                "'bulb' shines on the backs of 'floor' and 5 more polygons around it, which stay dark"));
  CHECK(said(room_scene(all, 5), "flipped").starts_with("'bulb' shines on the backs of 'floor' and 4 more"));
  CHECK(said(kHead + "  - {id: b, box: {size: [1, 1, 1]}, material: white}\n" + kBulb, "flipped")
            .starts_with("'bulb' shines on the backs of 'b.floor' and 5 more"));
  // A box beside a lamp is a box.
  CHECK(said(kHead + "  - {box: {size: [1, 0.8, 1]}, material: white}\n" + kBulb, "flipped") == "");
}

TEST_CASE("a lamp in its ceiling's plane is told, one that hangs below or looks up is not") {
  const auto lamp = [](const std::string& height, const std::string& up) {
    return room_scene({}, 6,
                      "  - {id: bulb, quad: {center: [0.5, " + height +
                          ", 0.5], size: [0.2, 0.2], normal: [0, " + up + ", 0]}, material: lamp}\n");
  };
  CHECK(said(lamp("1", "-1"), "coincident") == "'bulb' lies in the plane of 'ceiling' and overlaps it\n");
  CHECK(said(lamp("0.9999999", "-1"), "coincident") ==
        "'bulb' lies in the plane of 'ceiling' and overlaps it\n");
  CHECK(said(lamp("0.999", "-1"), "coincident") == "");
  CHECK(said(lamp("1", "1"), "coincident") == "");
}

TEST_CASE("discs in one plane are compared up to a number of pairs of their faces") {
  const auto discs = [](int sides) {
    const std::string disc = "disk: {radius: 1, sides: " + std::to_string(sides) + "}, material: white";
    return said(
        kHead + kLight + "  - {id: a, " + disc + "}\n  - {id: b, " + disc + ", translate: [1.5, 0, 0]}\n",
        "coincident");
  };
  CHECK(discs(100) == "'b' lies in the plane of 'a' and overlaps it\n");
  // Each has ten thousand corners and more faces: more pairs than are compared.
  CHECK(discs(10'000) == "");
}

TEST_CASE("what stands on a floor, abuts or fills a hole does not overlap") {
  const auto with = [](const std::string& rest) {
    return said(room_scene({}, 6, kBulb + rest), "coincident");
  };
  CHECK(with("  - {box: {at: [0.2, 0, 0.2], size: [0.2, 0.2, 0.2]}, material: white}\n") == "");
  CHECK(with("  - {grid: {origin: [0.2, 0.5, 0.2], u: [0, 0, 0.4], v: [0.4, 0, 0], cells: [4, 4]}, material: "
             "white}\n") == "");
  const std::string wall =
      "  - {polygon: [[0.5,0,0],[0.5,1,0],[0.5,1,1],[0.5,0,1]], holes: "
      "[[[0.5,.2,.2],[0.5,.2,.4],[0.5,.4,.4],[0.5,.4,.2]]], material: white}\n";
  CHECK(with(wall + "  - {polygon: [[0.5,.2,.2],[0.5,.4,.2],[0.5,.4,.4],[0.5,.2,.4]], material: white}\n") ==
        "");
  CHECK(with(wall + "  - {id: pane, polygon: [[0.5,.2,.2],[0.5,.41,.2],[0.5,.41,.4],[0.5,.2,.4]], material: "
                    "white}\n") == "'pane' lies in the plane of 'object8' and overlaps it\n");
  // Tilted, and far from the origin.
  CHECK(said(kHead + kLight +
                 "  - group:\n      - {id: a, quad: {size: [1, 1]}, material: white}\n"
                 "      - {id: b, quad: {size: [0.5, 0.5], center: [0.5, 0, 0.3]}, material: white}\n"
                 "    transform: [{rotate: {axis: [1, 2, 3], angle: 77}}, {translate: [30, -20, 10]}]\n",
             "coincident") == "'object2.b' lies in the plane of 'object2.a' and overlaps it\n");
}

}  // namespace
}  // namespace patchlight::test
