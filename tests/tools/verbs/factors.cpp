// The matrix as text, and what is told beside it.
#include "tools/verbs/factors.h"

#include "tools/base/json.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

// Three polygons of areas 1, 2 and 4, in files twice as long as the engine: A F is 0.5 between the first two,
// 0.2 between the last two, with an error of 0.01.
Scene make_scene() {
  Scene scene;
  scene.file = "room.yaml";
  scene.units = "cm";
  scene.units_per_length = 2;
  scene.polygons.id = {"floor", "lamps[0,1,0]", "wall"};
  return scene;
}
FactorTable make_table() {
  FactorTable table;
  table.area = {1, 2, 4};
  table.exchange = {0, 0.5, 0, 0, 0.2, 0};
  table.exchange_error = {0, 0, 0, 0, 0.01f, 0};
  table.row_done = 3, table.clear_count = 1, table.sampled_count = 1, table.ray_count = 64;
  return table;
}

template <class Format>
std::string collect(Format format) {
  std::string text;
  format([&](std::string_view part) { text += part; });
  return text;
}

}  // namespace

TEST_CASE("a summary tells sums of rows, their errors, and names the worst") {
  const FactorSummary summary = summarize_factors(make_table());
  CHECK(summary.row_sums == std::vector<double>{0.5, 0.25 + 0.1, 0.05});
  CHECK(summary.row_errors[0] == 0);
  CHECK(summary.row_errors[1] == doctest::Approx(0.005));
  CHECK(summary.row_errors[2] == doctest::Approx(0.0025));
  CHECK(summary.error_max == doctest::Approx(0.005));
  CHECK(summary.error_from == 1);
  CHECK(summary.error_to == 2);
  CHECK(summary.reciprocity_error_max <= 1e-15);
  CHECK(summary.worst == std::vector<uint32_t>{2, 1, 0});
}

TEST_CASE("the worst are those furthest from 1, at most five, without rows of nothing") {
  FactorTable table;
  table.area.assign(8, 1);
  table.exchange.assign(36, 0);
  // Polygon 7 sees nothing; the others see themselves, as bent ones do.
  for (size_t i = 0, entry = 0; i < 7; entry += 8 - i, ++i)
    table.exchange[entry] = 1 + (i % 2 ? 0.01 : -0.02) * static_cast<double>(i);
  table.exchange_error.assign(36, 0);
  CHECK(summarize_factors(table).worst == std::vector<uint32_t>{6, 4, 5, 2, 3});
}

TEST_CASE("csv: ids above, a row a polygon, areas in the scene's units") {
  const FactorTable table = make_table();
  const std::string text = collect(
      [&](const PutText& put) { format_factors_csv(put, make_scene(), table, summarize_factors(table)); });
  CHECK(text ==
        "polygon,area,floor,\"lamps[0,1,0]\",wall,row_sum,row_error\n"
        "floor,4,0,0.5,0,0.5,0\n"
        "\"lamps[0,1,0]\",8,0.25,0,0.1,0.35,0.005\n"
        "wall,16,0,0.05,0,0.05,0.0025\n");
}

TEST_CASE("json: the same, with an error beside every factor") {
  const FactorTable table = make_table();
  Scene scene = make_scene();
  scene.file = "a\"b\\\xff.yaml";  // Text from outside is escaped, and mended where it is not UTF-8.
  const Json json = Json::parse(collect([&](const PutText& put) {
    format_factors_json(put, scene, table, summarize_factors(table), {.error = 1e-3, .seed = 7});
  }));
  CHECK(json["scene"] == "a\"b\\\xef\xbf\xbd.yaml");
  CHECK(json["units"] == "cm");
  REQUIRE(json["polygons"].size() == 3);
  CHECK(json["polygons"][1]["id"] == "lamps[0,1,0]");
  CHECK(json["polygons"][1]["area"] == 8);
  CHECK(json["form_factors"] == Json::parse("[[0, 0.5, 0], [0.25, 0, 0.1], [0, 0.05, 0]]"));
  CHECK(json["errors"] == Json::parse("[[0, 0, 0], [0, 0, 0.005], [0, 0.0025, 0]]"));
  CHECK(json["row_sums"] == Json::parse("[0.5, 0.35, 0.05]"));
  CHECK(json["row_errors"] == Json::parse("[0, 0.005, 0.0025]"));
  CHECK(json["reciprocity_error_max"].get<double>() <= 1e-15);
  CHECK(json["error_max"]["from"] == "lamps[0,1,0]");
  CHECK(json["error_max"]["to"] == "wall");
  CHECK(json["worst"][0]["polygon"] == "wall");
  CHECK(json["worst"][0]["row_sum"] == 0.05);
  CHECK(json["pairs"] == Json::parse(R"({"clear": 1, "hidden": 0, "by_rays": 1})"));
  CHECK(json["rays"] == 64);
  CHECK(json["error_wanted"] == 0.001);
  CHECK(json["seed"] == 7);
}

TEST_CASE("a large matrix goes out in parts") {
  constexpr size_t kCount = 600;
  FactorTable table;
  table.area.assign(kCount, 1);
  table.exchange.assign(kCount * (kCount + 1) / 2, 1.0 / 3);
  table.exchange_error.assign(table.exchange.size(), 0);
  Scene scene = make_scene();
  scene.polygons.id.assign(kCount, "p");
  size_t parts = 0, longest = 0;
  format_factors_csv(
      [&](std::string_view part) {
        ++parts;
        longest = std::max(longest, part.size());
      },
      scene, table, summarize_factors(table));
  CHECK(parts > 2);
  CHECK(longest < 2'000'000);
}
