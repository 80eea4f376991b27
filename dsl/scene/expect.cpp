// The list `expect`.
#include "dsl/scene/expect.h"

#include "dsl/language/values.h"
#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace patchlight {
namespace {

constexpr uint64_t kMatchesPerPolygon = 8;  // of the limit

// Rows of polygons in the order of their ids.
std::vector<uint32_t> sort_by_id(const PolygonTable& polygons) {
  std::vector<uint32_t> sorted(polygons.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(),
            [&](uint32_t a, uint32_t b) { return polygons.id[a] < polygons.id[b]; });
  return sorted;
}

// The polygon of that id, or else all polygons below it, in their own order: ID.part, ID[i].
std::vector<uint32_t> find_polygons(const PolygonTable& polygons, const std::vector<uint32_t>& sorted,
                                    const std::string& id) {
  const auto from = [&](const std::string& text) {
    return std::lower_bound(sorted.begin(), sorted.end(), text,
                            [&](uint32_t p, const std::string& t) { return polygons.id[p] < t; });
  };
  if (const auto own = from(id); own != sorted.end() && polygons.id[*own] == id) return {*own};
  std::vector<uint32_t> below;
  for (const char mark : {'.', '['})
    for (auto row = from(id + mark); row != sorted.end() && polygons.id[*row].starts_with(id + mark); ++row)
      below.push_back(*row);
  std::sort(below.begin(), below.end());
  return below;
}

}  // namespace

void read_expectations(const Context& context, uint32_t list, Scene& scene) {
  const Tree& tree = context.tree;
  const std::vector<uint32_t> sorted = sort_by_id(scene.polygons);
  const Limits& limits = context.messages.limits;
  uint64_t count = 0;
  for (uint32_t child = tree.nodes[list].first; child != kNone; child = tree.nodes[child].next) {
    const MapValues map = read_map(context, child, kExpectKeys);
    if (!map.good) continue;
    Expectation expectation;
    const uint32_t name = value_of(map, "object").node;
    const Place place = place_of(tree, child);
    expectation.object = text_of(tree, name);
    expectation.file = context.messages.files[place.file].name;
    expectation.line = place.line;
    expectation.column = place.column;
    expectation.polygons = find_polygons(scene.polygons, sorted, expectation.object);
    if ((count += expectation.polygons.size()) > kMatchesPerPolygon * limits.polygons) {
      add_error(context.messages, place_of(tree, name), "too-many-polygons",
                fmt::format(
                    "what is expected names its polygons again and again: {} times more than the limit of {}",
                    kMatchesPerPolygon, limit_text(limits, &Limits::polygons)));
      return;
    }
    if (expectation.polygons.empty()) {
      const std::string near = wants_errors(context.messages)
                                   ? did_you_mean(expectation.object, scene.polygons.id)
                                   : std::string{};
      add_error(context.messages, place_of(tree, name), "bad-id",
                fmt::format("no object '{}'{}", escape_text(expectation.object),
                            near.empty() ? "" : fmt::format("; did you mean '{}'?", escape_text(near))));
      continue;
    }
    const uint32_t pass_node = value_of(map, "pass").node, pass_last = scene.solver.pass_count_max;
    expectation.after_last = pass_node == kNone;
    expectation.pass =
        expectation.after_last ? pass_last : static_cast<uint32_t>(value_of(map, "pass").integer[0]);
    if (expectation.pass > pass_last)
      add_error(context.messages, place_of(tree, pass_node), "snapshot-beyond-passes",
                fmt::format("pass {} is to be checked, but 'passes' is {}", expectation.pass, pass_last));
    expectation.radiosity = Rgb(vec3_of(value_of(map, "radiosity")));
    expectation.tolerance = value_of(map, "tolerance").number[0];
    scene.expectations.push_back(std::move(expectation));
  }
}

}  // namespace patchlight
