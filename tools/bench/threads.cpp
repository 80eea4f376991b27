// One large solve on more and more threads to speedups, and a look at whether the bits stay the same.
#include "engine/base/parallel.h"
#include "tools/bench/apart.h"
#include "tools/bench/figure.h"
#include "tools/bench/sections.h"
#include "tools/bench/solve_case.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr uint64_t kLarge = 1'000'000;
constexpr size_t kRunsMax = 3;  // a run takes a while

Json solve_on(const Scene& scene, const SolverSettings& settings, size_t threads) {
  const WorkersScope scope(std::make_shared<Workers>(threads));
  const auto surfaces = make_surfaces(scene.faces, scene.sky);
  const Times begin = read_clocks();
  const Solution solution = solve_whole(surfaces, settings);
  const Times spent = read_clocks() - begin;
  return {{"wall", spent.wall},
          {"processor", spent.processor},
          {"patches", solution.mesh.elements.size()},
          {"hash", fmt::format("{:016x}", find_solution_hash(solution))}};
}

std::vector<size_t> list_thread_counts(size_t most) {
  std::vector<size_t> counts;
  for (size_t count = 1; count < most; count *= 2) counts.push_back(count);
  counts.push_back(most);
  return counts;
}

}  // namespace

Json measure_threads(const BenchOptions& options, Talk& talk) {
  const Scene scene = load_quietly(options.scenes.front());
  const uint64_t count = std::min(options.max_patches, kLarge);
  const auto finer = settings_for_count(scene.faces, scene.solver, count);
  const SolverSettings settings = finer ? *finer : settings_within(scene, options.max_patches);
  const std::vector<size_t> thread_counts = list_thread_counts(options.threads);
  const size_t rounds = std::min(options.repetitions, kRunsMax);
  std::vector<std::vector<double>> wall(thread_counts.size()), processor = wall, speedup = wall, cores = wall;
  Json first;
  bool same = true;
  // Round robin, so that a speedup compares neighbours in time.
  for (size_t round = 0; round < rounds; ++round)
    for (size_t k = 0; k < thread_counts.size(); ++k) {
      say_progress(talk, fmt::format("threads: {} of {}", thread_counts[k], options.threads));
      const Json run = run_apart([&] { return solve_on(scene, settings, thread_counts[k]); });
      if (first.is_null()) first = run;
      same = same && run["hash"] == first["hash"];
      wall[k].push_back(run["wall"].get<double>());
      processor[k].push_back(run["processor"].get<double>());
      speedup[k].push_back(wall[0].back() / wall[k].back());
      cores[k].push_back(processor[k].back() / wall[k].back());
    }
  Json section = {{"scene", options.scenes.front()},
                  {"patches", first["patches"]},
                  {"solution_hash", first["hash"]},
                  {"same", same},
                  {"steps", Json::array()}};
  for (size_t k = 0; k < thread_counts.size(); ++k)
    section["steps"].push_back({{"threads", thread_counts[k]},
                                {"wall_seconds", make_figure(wall[k], "s")},
                                {"processor_seconds", make_figure(processor[k], "s")},
                                {"speedup", make_figure(speedup[k], "")},
                                {"cores_used", make_figure(cores[k], "")}});
  return section;
}

std::string format_threads(const Json& section) {
  std::string text = fmt::format("threads, solve of {}, {} patches\n", section["scene"].get<std::string>(),
                                 section["patches"].get<uint64_t>());
  for (const Json& row : section["steps"])
    text += fmt::format("  {:>3} threads: wall {}, speedup {}, CPU {}, cores used {}\n",
                        row["threads"].get<size_t>(), format_figure(row["wall_seconds"]),
                        format_figure(row["speedup"]), format_figure(row["processor_seconds"]),
                        format_figure(row["cores_used"]));
  text += section["same"].get<bool>() ? "  the same bits on all of them: " : "  DIFFERENT BITS; the first: ";
  return text + section["solution_hash"].get<std::string>() + "\n";
}

}  // namespace patchlight
