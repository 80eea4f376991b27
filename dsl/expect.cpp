// The list `expect`.
#include "expect.h"

#include "values.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

// The polygon of that id, or else all polygons below it: ID.part, ID[i].
std::vector<uint32_t> find_polygons(const PolygonTable& polygons, const std::string& id) {
  std::vector<uint32_t> below;
  for (uint32_t p = 0; p < polygons.size(); ++p) {
    const std::string& own = polygons.id[p];
    if (own == id) return {p};
    if (own.size() > id.size() && own.starts_with(id) && (own[id.size()] == '.' || own[id.size()] == '['))
      below.push_back(p);
  }
  return below;
}

}  // namespace

void read_expectations(const Context& context, uint32_t list, Scene& scene) {
  const Tree& tree = context.tree;
  for (uint32_t child = tree.nodes[list].first; child != kNone; child = tree.nodes[child].next) {
    const MapValues map = read_map(context, child, kExpectKeys);
    if (!map.good) continue;
    Expectation expectation;
    const uint32_t name = value_of(map, "object").node;
    expectation.object = text_of(tree, name);
    expectation.line = tree.nodes[child].line;
    expectation.polygons = find_polygons(scene.polygons, expectation.object);
    if (expectation.polygons.empty()) {
      const std::string near = did_you_mean(expectation.object, scene.polygons.id);
      add_error(context.messages, place_of(tree, name), "bad-id",
                fmt::format("no object '{}'{}", escape_text(expectation.object),
                            near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
      continue;
    }
    expectation.pass = static_cast<uint32_t>(value_of(map, "pass").integer[0]);
    expectation.radiosity = Rgb(vec3_of(value_of(map, "radiosity")));
    expectation.tolerance = value_of(map, "tolerance").number[0];
    scene.expectations.push_back(std::move(expectation));
  }
}

}  // namespace patchlight
