// One scene, finer and finer, to times and bytes, and to the power of the number of patches that they follow.
#include "engine/base/parallel.h"
#include "engine/solve/forecast.h"
#include "engine/solve/sizes.h"
#include "tools/base/format.h"
#include "tools/base/memory.h"
#include "tools/bench/apart.h"
#include "tools/bench/figure.h"
#include "tools/bench/sections.h"
#include "tools/bench/solve_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr uint64_t kFinest = 4'000'000, kCoarsest = 10'000, kFactor = 4;
constexpr size_t kStepsMin = 3;
constexpr double kStepSeconds = 10;  // a step that took so long is not repeated

Json solve_once(const Scene& scene, const SolverSettings& settings, size_t threads) {
  const WorkersScope scope(std::make_shared<Workers>(threads));
  const auto surfaces = make_surfaces(scene.faces, scene.sky);
  const Times begin = read_clocks();
  const Solution solution = solve_whole(surfaces, settings);
  const Times spent = read_clocks() - begin;
  return {{"patches", solution.mesh.elements.size()},
          {"form_factor_patches", solution.mesh.patches.size()},
          {"processor", spent.processor},
          {"wall", spent.wall},
          {"peak", find_memory_peak()}};
}

Json measure_step(const Scene& scene, const SolverSettings& settings, const BenchOptions& options) {
  std::vector<double> wall, processor, peak;
  Json once;
  do {
    once = run_apart([&] { return solve_once(scene, settings, options.threads); });
    wall.push_back(once["wall"].get<double>());
    processor.push_back(once["processor"].get<double>());
    peak.push_back(once["peak"].get<double>());
  } while (wall.size() < options.repetitions && wall[0] * static_cast<double>(wall.size()) < kStepSeconds);
  const double patches = once["patches"].get<double>();
  Json row = {{"patches", once["patches"]},
              {"form_factor_patches", once["form_factor_patches"]},
              {"processor_seconds", make_figure(processor, "s")},
              {"wall_seconds", make_figure(wall, "s")},
              {"bytes_peak", make_figure(peak, "B")}};
  row["bytes_per_patch"] = row["bytes_peak"]["median"].get<double>() / patches;
  return row;
}

// The slope of log y over log x by least squares.
double fit_exponent(const Json& rows, const char* column) {
  double n = 0, x1 = 0, y1 = 0, xx = 0, xy = 0;
  for (const Json& row : rows) {
    const double x = std::log(row["patches"].get<double>()),
                 y = std::log(row[column]["median"].get<double>());
    n += 1, x1 += x, y1 += y, xx += x * x, xy += x * y;
  }
  return (n * xy - x1 * y1) / (n * xx - x1 * x1);
}

}  // namespace

Json measure_growth(const BenchOptions& options, Talk& talk) {
  const Scene scene = load_quietly(options.scenes.front());
  const uint64_t memory = std::min(options.max_memory, find_memory_available());
  std::vector<uint64_t> counts;
  for (uint64_t count = std::min(options.max_patches, kFinest);
       (count >= kCoarsest || counts.size() < kStepsMin) && count > 0; count /= kFactor)
    counts.insert(counts.begin(), count);
  Json section = {{"scene", options.scenes.front()}, {"threads", options.threads}};
  Json steps = Json::array();
  for (const uint64_t count : counts) {
    const auto settings = settings_for_count(scene.faces, scene.solver, count);
    if (!settings) continue;  // the scene has too many faces for so few patches
    const uint64_t bytes =
        forecast_bytes(scene.faces, *settings, count_starting_patches(scene.faces, *settings));
    if (bytes > memory) {
      section["stopped"] = fmt::format("{} patches may need {}, {} are allowed", count, format_bytes(bytes),
                                       format_bytes(memory));
      break;
    }
    say_progress(talk, fmt::format("growth: up to {} patches", count));
    steps.push_back(measure_step(scene, *settings, options));
  }
  section["steps"] = steps;
  if (steps.size() < 2 || steps.front()["patches"] == steps.back()["patches"]) return section;
  for (const char* column : {"processor_seconds", "wall_seconds"}) {
    const double exponent = fit_exponent(steps, column);
    section["exponent"][column] = exponent;
    section["tenfold"][column] = std::pow(10.0, exponent);
  }
  // A start that costs the same at any size flatters the fit: the steepest step has less of it.
  double steepest = 0;
  for (size_t k = 1; k < steps.size(); ++k)
    if (steps[k]["patches"] > steps[k - 1]["patches"])
      steepest = std::max(steepest, fit_exponent(Json::array({steps[k - 1], steps[k]}), "processor_seconds"));
  section["exponent"]["steepest_step"] = steepest;
  section["tenfold"]["steepest_step"] = std::pow(10.0, steepest);
  // What a patch adds, without what the program takes anyway.
  section["bytes_per_added_patch"] =
      (steps.back()["bytes_peak"]["median"].get<double>() -
       steps.front()["bytes_peak"]["median"].get<double>()) /
      (steps.back()["patches"].get<double>() - steps.front()["patches"].get<double>());
  return section;
}

std::string format_growth(const Json& section) {
  std::string text = fmt::format("growth, solve of {} on {} threads; each run in a process of its own\n",
                                 section["scene"].get<std::string>(), section["threads"].get<size_t>());
  for (const Json& row : section["steps"])
    text += fmt::format("  {:>8} patches ({} with rows): CPU {}, wall {}, peak {}, {:.0f} bytes a patch\n",
                        row["patches"].get<uint64_t>(), row["form_factor_patches"].get<uint64_t>(),
                        format_figure(row["processor_seconds"]), format_figure(row["wall_seconds"]),
                        format_figure(row["bytes_peak"]), row["bytes_per_patch"].get<double>());
  if (section.contains("stopped")) text += "  stopped: " + section["stopped"].get<std::string>() + "\n";
  if (section.contains("exponent"))
    text += fmt::format(
        "  10x the patches: {:.1f}x the CPU time (exponent {:.3f}), {:.1f}x the wall time "
        "({:.3f})\n"
        "  in the steepest step {:.1f}x the CPU time ({:.3f}); {:.0f} bytes an added patch\n",
        section["tenfold"]["processor_seconds"].get<double>(),
        section["exponent"]["processor_seconds"].get<double>(),
        section["tenfold"]["wall_seconds"].get<double>(), section["exponent"]["wall_seconds"].get<double>(),
        section["tenfold"]["steepest_step"].get<double>(), section["exponent"]["steepest_step"].get<double>(),
        section["bytes_per_added_patch"].get<double>());
  return text;
}

}  // namespace patchlight
