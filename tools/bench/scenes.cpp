// Scenes to whole runs of the program, and to the share of such a run that Embree needs.
#include "dsl/scene/scene.h"
#include "engine/base/parallel.h"
#include "engine/trace/ray_tape.h"
#include "tools/bench/apart.h"
#include "tools/bench/figure.h"
#include "tools/bench/sections.h"
#include "tools/bench/solve_case.h"
#include "tools/render/render.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace patchlight {
namespace {

constexpr const char* kStages[] = {"load", "trace", "split", "solve", "render", "write", "total"};
constexpr double kReplaySeconds = 0.2;

struct TemporaryFolder {
  std::string path = std::filesystem::temp_directory_path() / "patchlight-bench-XXXXXX";
  TemporaryFolder() {
    if (!mkdtemp(path.data())) throw std::runtime_error("no temporary folder can be made");
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

// The report of one run of the verb render, pictures and all.
Json run_render(const std::string& scene, const BenchOptions& options, uint64_t max_patches) {
  const TemporaryFolder folder;
  Options render_options;
  render_options.scene = scene;
  render_options.out = folder.path;
  const std::string report_path = folder.path + "/report.json";
  render_options.own = RenderOptions{.report = report_path};
  render_options.threads = static_cast<uint32_t>(options.threads);
  render_options.max_patches = max_patches;
  render_options.quiet = render_options.json = true;
  return run_apart([&] {
    Talk silent = make_talk(render_options);
    const Times begin = read_clocks();
    render(render_options, silent);
    std::ifstream file(report_path);
    Json report = Json::parse(file);
    report["processor_seconds"] = (read_clocks() - begin).processor;
    return report;
  });
}

// Processor seconds that bare Embree needs for as many rays as went over the track.
double find_bare_seconds(const Tracer& tracer, const TapeTrack& track,
                         void (*play)(const Tracer&, Replay&, RayOrder)) {
  const auto kept = static_cast<double>(count_kept_rays(track));
  if (kept == 0) return 0;
  Replay replay = make_replay(track);
  double best = 0;
  for (const RayOrder order : {RayOrder::kCoherent, RayOrder::kIncoherent}) {
    play(tracer, replay, order);
    const Times begin = read_clocks();
    double rays = 0;
    Times spent;
    do {
      for (int k = 0; k < 16; ++k) play(tracer, replay, order), rays += kept;
      spent = read_clocks() - begin;
    } while (spent.wall < kReplaySeconds);
    best = std::max(best, rays / spent.processor);
  }
  return static_cast<double>(track.ray_count) / best;
}

// One solve on one thread, with its rays on tape: their true number, what bare Embree would need for them,
// and the error of the answer where it is known.
Json solve_on_tape(const std::string& path, uint64_t max_patches) {
  const WorkersScope scope(std::make_shared<Workers>(1));
  const Scene scene = load_quietly(path);
  const SolverSettings settings = settings_within(scene, max_patches);
  const auto surfaces = make_surfaces(scene.faces, scene.sky);
  const Tracer& tracer = surfaces->tracer;
  RayTape tape;
  observe_rays(tracer, &tape);
  const Times begin = read_clocks();
  const Solution solution = solve_whole(surfaces, settings);
  const Times spent = read_clocks() - begin;
  observe_rays(tracer, nullptr);
  const double bare = find_bare_seconds(tracer, tape.visibility, replay_blocked) +
                      find_bare_seconds(tracer, tape.nearest, replay_nearest);
  Json result = {{"visibility_rays", tape.visibility.ray_count},
                 {"nearest_hit_rays", tape.nearest.ray_count},
                 {"solve_processor_seconds", spent.processor},
                 {"bare_traversal_seconds", bare},
                 {"bare_traversal_share", bare / spent.processor}};
  if (const auto error = find_known_error(solution, scene)) result["error"] = *error;
  return result;
}

Json measure_scene(const std::string& path, const BenchOptions& options, Talk& talk) {
  const uint64_t max_patches = settings_within(load_quietly(path), options.max_patches).patch_count_max;
  std::vector<Json> reports;
  for (size_t k = 0; k < options.repetitions; ++k) {
    say_progress(talk, fmt::format("{}: run {} of {}", path, k + 1, options.repetitions));
    reports.push_back(run_render(path, options, max_patches));
  }
  const auto collect = [&](auto&& value_of, std::string_view unit) {
    std::vector<double> runs;
    for (const Json& report : reports) runs.push_back(value_of(report));
    return make_figure(std::move(runs), unit);
  };
  const Json& last = reports.back();
  Json row = {{"scene", path},
              {"patches", last["patches"]},
              {"threads", last["threads"]},
              {"passes", last["stopped"]["pass"]},
              {"solution_hash", last["solution_hash"]},
              {"closure_error", last["power"]["closure_error"]}};
  for (const char* stage : kStages)
    row["seconds"][stage] =
        collect([&](const Json& report) { return report["seconds"][stage].get<double>(); }, "s");
  row["processor_seconds"] =
      collect([](const Json& report) { return report["processor_seconds"].get<double>(); }, "s");
  row["bytes_peak"] = collect([](const Json& report) { return report["bytes"]["peak"].get<double>(); }, "B");
  say_progress(talk, path + ": rays on tape");
  row.update(run_apart([&] { return solve_on_tape(path, max_patches); }));
  const double rays = row["visibility_rays"].get<double>() + row["nearest_hit_rays"].get<double>();
  row["rays_per_second"] = collect(
      [&](const Json& report) {
        const Json& s = report["seconds"];
        return rays / (s["trace"].get<double>() + s["split"].get<double>() + s["solve"].get<double>());
      },
      "rays/s");
  row["bytes_per_patch"] = row["bytes_peak"]["median"].get<double>() / row["patches"].get<double>();
  return row;
}

}  // namespace

Json measure_scenes(const BenchOptions& options, Talk& talk) {
  Json rows = Json::array();
  for (const std::string& scene : options.scenes) rows.push_back(measure_scene(scene, options, talk));
  return rows;
}

std::string format_scenes(const Json& section) {
  std::string text = fmt::format("scenes, whole program on {} threads; median (lowest .. highest)\n",
                                 section.empty() ? 0 : section[0]["threads"].get<size_t>());
  for (const Json& row : section) {
    text +=
        fmt::format("  {}: {}\n", row["scene"].get<std::string>(), format_figure(row["seconds"]["total"]));
    std::string stages;
    for (const char* stage : kStages)
      if (std::string_view(stage) != "total")
        stages += fmt::format("{}{} {:.3f}", stages.empty() ? "" : ", ", stage,
                              row["seconds"][stage]["median"].get<double>());
    text +=
        fmt::format("    seconds: {}; of processors {}\n", stages, format_figure(row["processor_seconds"]));
    text +=
        fmt::format("    {} patches, {} passes, {}rays, {}; peak {}, {:.0f} bytes a patch\n",
                    row["patches"].get<uint64_t>(), row["passes"].get<uint64_t>(),
                    format_si(row["visibility_rays"].get<double>() + row["nearest_hit_rays"].get<double>()),
                    format_figure(row["rays_per_second"]), format_figure(row["bytes_peak"]),
                    row["bytes_per_patch"].get<double>());
    text += fmt::format(
        "    power ledger closes to {:.2g}{}; bare traversal of the same rays: {:.0f} % of the "
        "solve's CPU time\n",
        row["closure_error"].get<double>(),
        row.contains("error")
            ? fmt::format("; largest error against the known answer {:.2g}", row["error"].get<double>())
            : "",
        100 * row["bare_traversal_share"].get<double>());
  }
  return text;
}

}  // namespace patchlight
