// Large scenes to the time and memory that loading them takes, beside the YAML parser alone on the same text.
#include "dsl/scene/load.h"
#include "dsl/yaml/bare_pass.h"
#include "tools/bench/apart.h"
#include "tools/bench/figure.h"
#include "tools/bench/sections.h"
#include "tools/bench/solve_case.h"
#include "tools/memory.h"
#include "tools/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace patchlight {
namespace {

constexpr uint64_t kPolygons = 40'000;  // 7 MB

const std::string kHead =
    "patchlight: 1\nmaterials: {white: {reflectance: 0.7}, lamp: {emission: 10}}\n"
    "solver: {max_patches: 1000000000}\n";
const std::string kLamp =
    "{\"id\": \"lamp\", \"quad\": {\"center\": [0, 60, 0], \"size\": [20, 20], \"normal\": [0, -1, 0]}, "
    "\"material\": \"lamp\"}";

// A rectangle somewhere, turned in some way, as a list of corners with five decimals.
std::string make_polygon(std::mt19937_64& random) {
  const auto pick = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const double z = pick(-1, 1), turn = pick(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
  const DVec3 normal(r * std::cos(turn), r * std::sin(turn), z);
  const DVec3 u = glm::normalize(glm::cross(normal, std::abs(z) < 0.7 ? DVec3(0, 0, 1) : DVec3(1, 0, 0)));
  const DVec3 v = glm::cross(normal, u), middle(pick(-20, 20), pick(-20, 20), pick(-20, 20));
  const DVec3 half_u = u * pick(0.2, 1), half_v = v * pick(0.2, 1);
  std::string text = "[";
  for (const DVec3& p : {middle - half_u - half_v, middle + half_u - half_v, middle + half_u + half_v,
                         middle - half_u + half_v})
    text += fmt::format("{}[{:.5f}, {:.5f}, {:.5f}]", text.size() > 1 ? ", " : "", p.x, p.y, p.z);
  return text + "]";
}

std::string make_polygons(uint64_t count) {
  std::mt19937_64 random(1);
  std::string text = kHead + "objects:\n  - " + kLamp + "\n";
  for (uint64_t k = 0; k < count; ++k)
    text += fmt::format("  - {{id: p{}, material: white, polygon: {}}}\n", k, make_polygon(random));
  return text;
}

// The same as one line of JSON.
std::string make_json(uint64_t count) {
  std::mt19937_64 random(1);
  std::string text =
      "{\"patchlight\": 1, \"materials\": {\"white\": {\"reflectance\": 0.7}, \"lamp\": {\"emission\": 10}}, "
      "\"solver\": {\"max_patches\": 1000000000}, \"objects\": [" +
      kLamp;
  for (uint64_t k = 0; k < count; ++k)
    text += fmt::format(", {{\"id\": \"p{}\", \"material\": \"white\", \"polygon\": {}}}", k,
                        make_polygon(random));
  return text + "]}\n";
}

std::string make_keys(uint64_t count) {
  std::string text = kHead + "objects:\n  - " + kLamp + "\nlet:\n";
  for (uint64_t k = 0; k < count * 5 / 2; ++k) text += fmt::format("  variable_{0}: {0}\n", k);
  return text;
}

std::string make_materials(uint64_t count) {
  std::string text = "patchlight: 1\nmaterials:\n  lamp: {emission: 10}\n";
  for (uint64_t k = 0; k < count / 2; ++k)
    text += fmt::format("  m{}: {{reflectance: [0.{}, 0.5, 0.25]}}\n", k, k % 10);
  text += "objects:\n  - " + kLamp + "\n";
  for (uint64_t k = 0; k < count / 2; ++k)
    text += fmt::format("  - {{quad: {{center: [{}, 0, {}], size: [1, 1]}}, material: m{}}}\n", k % 200 * 2,
                        k / 200 * 2, k);
  return text;
}

// A million wrong numbers.
std::string make_errors(uint64_t count) {
  std::string text = kHead + "objects:\n";
  for (uint64_t k = 0; k < count / 12; ++k) {
    text += "  - {material: white, polygon: [";
    for (int corner = 0; corner < 100; ++corner) text += "[a, b, c], ";
    text += "]}\n";
  }
  return text;
}

struct LoadCase {
  const char* name;
  std::string (*make)(uint64_t polygons);
};
constexpr LoadCase kCases[] = {{"polygons", make_polygons},
                               {"the same as JSON", make_json},
                               {"keys of one map", make_keys},
                               {"materials", make_materials},
                               {"errors", make_errors}};

Json load_once(const std::string& text) {
  const Times begin = read_clocks();
  uint64_t polygons = 0, errors = 0;
  try {
    std::vector<Diagnostic> warnings;
    polygons = load_scene_text(text, "scene.yaml", warnings).polygons.size();
  } catch (const UserError& error) {
    errors = error.diagnostics.size() + error.more;
  }
  const Times spent = read_clocks() - begin;
  return {{"processor", spent.processor},
          {"peak", find_memory_peak()},
          {"polygons", polygons},
          {"errors", errors}};
}

Json pass_once(const std::string& text) {
  const Times begin = read_clocks();
  const uint64_t events = count_yaml_events(text);
  return {{"processor", (read_clocks() - begin).processor}, {"peak", find_memory_peak()}, {"events", events}};
}

Json measure_case(const LoadCase& row, uint64_t polygons, const BenchOptions& options, Talk& talk) {
  std::vector<double> load, pass, ratio, load_peak, pass_peak;
  Json result = {{"name", row.name}, {"bytes", row.make(polygons).size()}};
  for (size_t k = 0; k < options.repetitions; ++k) {
    say_progress(talk, fmt::format("loading {}: run {} of {}", row.name, k + 1, options.repetitions));
    const Json passed = run_apart([&] { return pass_once(row.make(polygons)); });
    const Json loaded = run_apart([&] { return load_once(row.make(polygons)); });
    pass.push_back(passed["processor"].get<double>());
    load.push_back(loaded["processor"].get<double>());
    ratio.push_back(load.back() / std::max(pass.back(), 1e-6));
    pass_peak.push_back(passed["peak"].get<double>());
    load_peak.push_back(loaded["peak"].get<double>());
    result["events"] = passed["events"];
    for (const char* key : {"polygons", "errors"}) result[key] = loaded[key];
  }
  result["load_seconds"] = make_figure(load, "s");
  result["pass_seconds"] = make_figure(pass, "s");
  result["ratio"] = make_figure(ratio, "");
  result["load_bytes_peak"] = make_figure(load_peak, "B");
  result["pass_bytes_peak"] = make_figure(pass_peak, "B");
  return result;
}

}  // namespace

Json measure_loading(const BenchOptions& options, Talk& talk) {
  Json rows = Json::array();
  for (const LoadCase& row : kCases)
    rows.push_back(measure_case(row, std::min(kPolygons, options.max_patches), options, talk));
  return rows;
}

std::string format_loading(const Json& section) {
  std::string text =
      "loading, on one thread: texts to faces, and yaml-cpp's events of the same texts thrown away\n";
  for (const Json& row : section)
    text += fmt::format(
        "  {}: {}, {} events, {} polygons, {} errors\n    load {}, events alone {}, ratio {}; peak {}, and "
        "{}\n",
        row["name"].get<std::string>(), format_bytes(row["bytes"].get<uint64_t>()),
        row["events"].get<uint64_t>(), row["polygons"].get<uint64_t>(), row["errors"].get<uint64_t>(),
        format_figure(row["load_seconds"]), format_figure(row["pass_seconds"]), format_figure(row["ratio"]),
        format_figure(row["load_bytes_peak"]), format_figure(row["pass_bytes_peak"]));
  return text;
}

}  // namespace patchlight
