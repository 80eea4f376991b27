// The report as JSON.
#include "tools/base/json.h"
#include "tools/export/run_report.h"

#include <doctest/doctest.h>

using namespace patchlight;

namespace {

// Two polygons: the first of two patches, of which one loses half of its rays; the second sees everything.
struct Example {
  Scene scene;
  Solution solution;
  Example() {
    scene.file = "room.yaml";
    scene.units_per_length = 2;
    scene.metres_per_unit = 0.5;
    scene.polygons.id = {"floor", "roof"};
    scene.faces.polygon = {0, 1};
    solution.mesh.patches.face = {0, 0, 1};
    solution.mesh.patches.area = {3, 1, 1};
    solution.transport.receivers.receiver_of = {0, 1, 2};
    solution.transport.hits.ray_count = 2;
    // Two on lit sides or backs; one of two; the one that is not buried.
    solution.transport.hits.nothing = {0, 1, 0};
    solution.transport.hits.buried = {0, 0, 1};
    solution.log.passes.push_back(
        {.pass = 1, .ray_count = 5, .added_power = DRgb(8), .added_largest = 1, .seconds = 0});
  }
};

}  // namespace

TEST_CASE("a row sum is the share of rays that hit, weighted by area; buried rays do not count") {
  const Example example;
  const std::vector<double> sums = find_row_sums(example.solution, example.scene.faces, 2);
  CHECK(sums[0] == doctest::Approx((3 * 1.0 + 1 * 0.5) / 4));
  CHECK(sums[1] == 1);
}

TEST_CASE("the report has its fields, and powers are in W") {
  const Example example;
  RunReport report;
  report.stopped_reason = "converged";
  report.thread_count = 2;
  report.exposure_ev = -1.5;
  report.solution_hash = 255;
  report.power = PowerLedger{.emitted = DRgb(1), .absorbed = DRgb(1), .escaped = DRgb(0), .unshot = DRgb(0)};
  report.health.row_sums = find_row_sums(example.solution, example.scene.faces, 2);
  const Json json = Json::parse(format_report(report, example.scene, example.solution));
  CHECK(json["scene"] == "room.yaml");
  CHECK(json["polygons"] == 2);
  CHECK(json["threads"] == 2);
  CHECK(json["exposure"] == -1.5);
  CHECK(json["solution_hash"] == "00000000000000ff");
  CHECK(json["stopped"]["reason"] == "converged");
  CHECK(json["stopped"]["pass"] == 1);
  CHECK(json["passes"][0]["rays"] == 5);
  // A length is 2 units of 0.5 m: one metre, so powers stay as they are.
  CHECK(json["passes"][0]["added_power"][0] == 8.0);
  CHECK(json["power"]["emitted"][2] == 1.0);
  CHECK(json["form_factors"]["row_sum_min"] == 0.875);
  CHECK(json["form_factors"]["row_sum_max"] == 1.0);
  REQUIRE(json["form_factors"]["worst"].size() == 1);
  CHECK(json["form_factors"]["worst"][0]["polygon"] == "floor");
  for (const char* stage : {"load", "trace", "split", "solve", "render", "write", "total"})
    CHECK(json["seconds"].contains(stage));
}

TEST_CASE("what was not measured is not in the report") {
  Example example;
  example.solution = Solution{};
  RunReport report;
  report.stopped_reason = "signal";
  report.stopped_signal = "SIGINT";
  const Json json = Json::parse(format_report(report, example.scene, example.solution));
  CHECK(json["stopped"]["signal"] == "SIGINT");
  CHECK(json["stopped"]["pass"] == 0);
  for (const char* field : {"power", "form_factors", "exposure", "solution_hash"})
    CHECK(!json.contains(field));
}
