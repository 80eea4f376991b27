// A finished run -> S-report.json.
#include "tools/base/format.h"
#include "tools/base/json.h"
#include "tools/base/memory.h"
#include "tools/base/version.h"
#include "tools/export/exporters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace patchlight {
namespace {

constexpr int kReportVersion = 1;
constexpr size_t kWorstCount = 5;
constexpr size_t kStepsMax = 1000;
constexpr size_t kPolygonsMax = 1000;
constexpr size_t kObjectsMax = 10'000;

Json rgb(const DRgb& value) { return {value.r, value.g, value.b}; }

// Rows by polygon; the worst are those that sum to least: where light leaves, or leaks.
Json make_form_factors(const Health& health, const PolygonTable& polygons) {
  const std::vector<double>& sums = health.row_sums;
  std::vector<size_t> order;
  for (size_t polygon = 0; polygon < sums.size(); ++polygon)
    if (sums[polygon] >= 0) order.push_back(polygon);
  if (order.empty()) return {};
  const auto describe = [&](size_t polygon) {
    Json row = {{"polygon", polygons.id[polygon]}, {"row_sum", sums[polygon]}};
    if (!health.reciprocity_errors.empty()) row["reciprocity_error"] = health.reciprocity_errors[polygon];
    return row;
  };
  Json json = {{"by_polygon", Json::array()}};
  if (order.size() <= kPolygonsMax)
    for (const size_t polygon : order) json["by_polygon"].push_back(describe(polygon));
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return sums[a] < sums[b]; });
  json["row_sum_min"] = sums[order.front()];
  json["row_sum_max"] = sums[order.back()];
  if (!health.reciprocity_errors.empty())
    json["reciprocity_error_max"] =
        *std::max_element(health.reciprocity_errors.begin(), health.reciprocity_errors.end());
  json["escaped_share"] = health.leaks.escaped;
  json["escaped_through_cracks"] = health.leaks.through_cracks;
  json["worst"] = Json::array();
  for (const size_t polygon : order) {
    if (json["worst"].size() == kWorstCount || sums[polygon] >= 1) break;
    json["worst"].push_back(describe(polygon));
  }
  return json;
}

// What each object gives and takes. Heat has one channel.
Json make_objects(const ObjectPowerTable& power, const Scene& scene) {
  const auto number = [&](const DRgb& value) { return scene.is_heat ? Json(value.g) : rgb(value); };
  Json objects = Json::array();
  for (size_t object = 0; object < std::min(power.size(), kObjectsMax); ++object)
    objects.push_back({{"object", scene.object_ids[object]},
                       {"area", power.area[object]},
                       {"emitted_power", number(power.emitted[object])},
                       {"received_power", number(power.received[object])},
                       {"absorbed_power", number(power.absorbed[object])},
                       {"net_power", number(find_net_power(power, object))}});
  return objects;
}

// Shares of the mean light of what pictures show, and of all surfaces; of an object, on its own area.
Json make_error(const ErrorTable& error, const Scene& scene) {
  const auto describe = [](const ErrorParts& parts, double factor) {
    return Json{{"estimate", factor * parts.estimate()},
                {"noise_direct", factor * parts.noise_direct},
                {"noise_rows", factor * parts.noise_rows},
                {"mesh", factor * parts.mesh},
                {"passes", factor * parts.passes}};
  };
  Json json = describe(error.shown, 1);
  json["surfaces"] = describe(error.surfaces, 1);
  json["asked"] = scene.solver.error;
  const size_t count = std::min(scene.object_ids.size(), kObjectsMax);
  std::vector<ErrorParts> parts(count);
  std::vector<double> area(count, 0);
  double area_sum = 0;
  for (size_t polygon = 0; polygon < error.polygon.size(); ++polygon) {
    area_sum += error.polygon_area[polygon];
    const size_t object = scene.polygons.object[polygon];
    if (object >= count) continue;
    area[object] += error.polygon_area[polygon];
    parts[object].noise_direct += error.polygon[polygon].noise_direct;
    parts[object].noise_rows += error.polygon[polygon].noise_rows;
    parts[object].mesh += error.polygon[polygon].mesh;
    parts[object].passes += error.polygon[polygon].passes;
  }
  json["objects"] = Json::array();
  for (size_t object = 0; object < count; ++object) {
    if (area[object] <= 0) continue;
    Json row = describe(parts[object], area_sum / area[object]);
    row["object"] = scene.object_ids[object];
    json["objects"].push_back(row);
  }
  return json;
}

}  // namespace

uint64_t count_rays(const RunReport& report, const Solution& solution) {
  // Not the sums of rounds and passes: a pass names the rays whose results it uses first, cast in a round or
  // not.
  return report.film_rays + solution.log.direct_ray_count + solution.log.transport_ray_count;
}

std::string format_report(const RunReport& report, const Scene& scene, const Solution& solution) {
  // Areas are in engine lengths squared, powers in W/m2 times that.
  const double metres_per_length = scene.metres_per_length();
  const double power_scale = metres_per_length * metres_per_length;
  Json json;
  json["patchlight"] = version_number();
  json["report_version"] = kReportVersion;
  json["scene"] = scene.file;
  if (!scene.title.empty()) json["title"] = scene.title;
  json["units"] = scene.units;
  json["polygons"] = scene.polygons.size();
  json["faces"] = scene.faces.size();
  json["patches"] = solution.mesh.elements.size();
  // The coarse tree that carries light between surfaces, and the rows of form factors that its patches share.
  json["transport"] = {{"patches", solution.mesh.patches.size()},
                       {"rows", solution.transport.receivers.size()},
                       {"rays_per_row", solution.transport.hits.ray_count},
                       {"form_factors", scene.solver.keep_rows ? "cached" : "recompute"}};
  json["threads"] = report.thread_count;
  if (report.solution_hash) json["solution_hash"] = fmt::format("{:016x}", *report.solution_hash);
  if (report.exposure_ev) json["exposure"] = *report.exposure_ev;

  json["rounds"] = Json::array();
  for (const RoundReport& round : solution.log.rounds)
    json["rounds"].push_back({{"round", round.round},
                              {"patches", round.patch_count},
                              {"split", round.split_count},
                              {"rays", round.ray_count},
                              {"seconds", round.seconds}});
  const std::string step(report.solver.step), steps = name_steps(step);
  json["solver"] = report.solver.name;
  json["form_factors_found"] = solution.log.factor_count;
  json[steps] = Json::array();
  // Shots are many: a thousand of them tell how it went.
  const size_t count = solution.log.passes.size(), stride = (count + kStepsMax - 1) / kStepsMax;
  for (size_t k = 0; k < count; ++k)
    if (const PassReport& pass = solution.log.passes[k]; k % stride == 0 || k + 1 == count)
      json[steps].push_back({{step, pass.pass},
                             {"rays", pass.ray_count},
                             {"added_power", rgb(pass.added_power * power_scale)},
                             {"unshot_power", rgb(pass.unshot_power * power_scale)},
                             {"seconds", pass.seconds}});
  json["stopped"] = {{"reason", report.stopped_reason}, {step, count}};
  if (!report.stopped_signal.empty()) json["stopped"]["signal"] = report.stopped_signal;
  if (report.power)
    json["power"] = {{"emitted", rgb(report.power->emitted * power_scale)},
                     {"absorbed", rgb(report.power->absorbed * power_scale)},
                     {"escaped", rgb(report.power->escaped * power_scale)},
                     {"unshot", rgb(report.power->unshot * power_scale)},
                     {"closure_error", report.power->closure_error}};

  if (report.error) json["error"] = make_error(*report.error, scene);
  if (const Json objects = make_objects(report.objects, scene); !objects.empty()) json["objects"] = objects;

  const StageSeconds& seconds = report.seconds;
  json["seconds"] = {{"load", seconds.load},   {"trace", seconds.trace},   {"split", seconds.split},
                     {"solve", seconds.solve}, {"render", seconds.render}, {"write", seconds.write},
                     {"total", seconds.total}};
  json["bytes"] = {{"solution", count_bytes(solution)},
                   {"film", report.film_bytes},
                   {"forecast", report.forecast_bytes},
                   {"peak", find_memory_peak()}};
  const Json form_factors = make_form_factors(report.health, scene.polygons);
  if (!form_factors.is_null()) json["form_factors"] = form_factors;
  return format_json(json);
}

void export_report(NewFile& file, const FinishedRun& run) {
  append_file(file, format_report(run.report, run.scene, run.solution));
}

}  // namespace patchlight
