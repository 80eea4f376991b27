// The list `objects` to outlines, before anything is checked or cut: ids, corners, materials.
#include "dsl/shapes/objects.h"

#include "dsl/language/variables.h"
#include "dsl/report/text.h"
#include "dsl/shapes/object_keys.h"
#include "dsl/shapes/shapes.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace patchlight::test {
namespace {

// What a list of objects becomes; the materials are a and b.
struct Built {
  Messages messages;
  Tree tree;
  VariableTable variables;
  SceneObjects scene;
  explicit Built(const std::string& text) {
    messages.files.push_back({"t.yaml", text});
    const uint32_t root = parse_tree(messages, 0, tree);
    REQUIRE(root != kNone);
    for (const char* name : {"a", "b"}) {
      scene.materials.row_of.emplace(name, static_cast<uint32_t>(scene.materials.size()));
      scene.materials.name.emplace_back(name);
      scene.materials.reflectance.emplace_back(0.5);
      scene.materials.emission.emplace_back(0);
      scene.materials.node.push_back(root);
      scene.materials.used.push_back(0);
    }
    scene.materials.named_count = scene.materials.size();
    read_objects({tree, messages, &variables}, root, scene);
    check_ids({tree, messages}, scene.objects, scene.outlines);
  }
  // "id material corners" of an outline: "q.floor a [0,0,0] [1,0,0] ...".
  std::string outline(size_t p) const {
    const OutlineTable& table = scene.outlines;
    std::string text = table.id[p] + " " + scene.materials.name[table.material[p]];
    const uint32_t ring = table.polygon_first[p];
    for (uint32_t k = table.ring_first[ring]; k < table.ring_first[ring + 1]; ++k)
      text += fmt::format(" {},{},{}", number_text(table.corners[k].x), number_text(table.corners[k].y),
                          number_text(table.corners[k].z));
    return text;
  }
};

TEST_CASE("a polygon keeps its corners and holes as they stand") {
  const Built built(
      "- {id: p, polygon: [[0,0,0],[4,0,0],[0,0,4]], holes: [[[1,0,1],[2,0,1],[1,0,2]]], material: b}");
  REQUIRE(built.messages.errors.empty());
  REQUIRE(built.scene.outlines.size() == 1);
  CHECK(built.outline(0) == "p b 0,0,0 4,0,0 0,0,4");
  CHECK(built.scene.outlines.ring_node.size() == 2);
  CHECK(built.scene.outlines.corners.size() == 6);
}

TEST_CASE("a quad lies about its centre, its width along x, or spans u and v") {
  const Built built(
      "- {quad: {size: [2, 4]}, material: a}\n- {quad: {origin: [1,1,1], u: [2,0,0], v: [0,0,3]}, material: "
      "a}\n");
  REQUIRE(built.messages.errors.empty());
  CHECK(built.outline(0) == "object1 a -1,0,2 1,0,2 1,0,-2 -1,0,-2");
  CHECK(built.outline(1) == "object2 a 1,1,1 3,1,1 3,1,4 1,1,4");
}

TEST_CASE("a box has six named sides, a room those that are not left out, with materials of their own") {
  const Built built(
      "- {id: box, box: {size: [1, 2, 3]}, material: a}\n"
      "- {id: room, room: {size: [1, 2, 3], omit: [left, back], walls: {floor: b}}, material: a}\n");
  REQUIRE(built.messages.errors.empty());
  REQUIRE(built.scene.outlines.size() == 10);
  CHECK(built.outline(0) == "box.floor a 0,0,0 1,0,0 1,0,3 0,0,3");
  CHECK(built.outline(6) == "room.floor b 0,0,3 1,0,3 1,0,0 0,0,0");
  CHECK(built.outline(7).starts_with("room.ceiling a "));
  CHECK(built.outline(8).starts_with("room.right a "));
  CHECK(built.outline(9).starts_with("room.front a "));
}

TEST_CASE("corners that repeat are left out of a prism's base, with a warning at their place") {
  const Built built("- {prism: {base: [[0,0,0],[0,0,1],[0,0,1],[1,0,0],[0,0,0]], height: 2}, material: a}");
  REQUIRE(built.messages.errors.empty());
  CHECK(built.scene.outlines.size() == 5);
  REQUIRE(built.messages.warnings.size() == 2);
  CHECK(built.messages.warnings[0].slug == "repeated-vertex");
  CHECK(built.messages.warnings[0].column == 35);
  CHECK(built.messages.warnings[1].slug == "closed-ring");
}

TEST_CASE("ids are compared within their list, with those of parts, and with second sides") {
  const auto said = [](const std::string& text) {
    const Built built(text);
    return built.messages.errors.empty() ? std::string{} : built.messages.errors[0].message;
  };
  const std::string quad = "quad: {size: [1, 1]}, material: a}\n";
  CHECK(said("- {id: x, " + quad + "- {id: x, box: {size: [1,1,1]}, material: a}\n") ==
        "the id 'x' is taken: first defined at 1:8");
  CHECK(said("- {id: x, box: {size: [1,1,1]}, material: a}\n- {id: x.floor, " + quad)
            .starts_with("the id 'x.floor'"));
  CHECK(said("- {id: x, two_sided: true, " + quad + "- {id: x.back, " + quad)
            .starts_with("the id 'x.back' is taken"));
  CHECK(said("- {id: g, group: [{id: x, " + quad.substr(0, quad.size() - 1) + ", {id: x, " +
             quad.substr(0, quad.size() - 1) + "]}\n")
            .starts_with("the id 'x' is taken"));
  CHECK(said("- {id: g, group: []}\n- {id: g, " + quad).starts_with("the id 'g' is taken"));
  CHECK(said("- &o {id: x, " + quad + "- *o\n") == "the id 'x' is taken: first defined at 1:11");
  // In two groups, or under a prefix, the same name is another.
  CHECK(said("- {id: g, group: [{id: x, " + quad.substr(0, quad.size() - 1) + "]}\n- {id: x, " + quad) == "");
}

TEST_CASE("every shape is reached by its name and has a description") {
  for (const ShapeRow& shape : shape_rows()) {
    CAPTURE(shape.name);
    CHECK((shape.build != nullptr));
    CHECK(shape.description.ends_with('.'));
    CHECK(row_of(object_keys(), shape.name).type == shape.type);
    CHECK((shape.keys != nullptr) == (shape.type == ValueType::kMap));
  }
}

}  // namespace
}  // namespace patchlight::test
