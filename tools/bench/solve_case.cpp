// A scene and a size to a solved mesh, its times and its error.
#include "tools/bench/solve_case.h"

#include "dsl/scene/load.h"
#include "engine/solve/sizes.h"
#include "tools/render/expectations.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace patchlight {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

bool is_closed(const Solution& solution) {
  const auto is_none = [](const std::vector<uint32_t>& column) {
    return std::all_of(column.begin(), column.end(), [](uint32_t count) { return count == 0; });
  };
  return is_none(solution.transport.hits.nothing) && is_none(solution.transport.hits.back);
}

bool is_furnace(const Solution& solution, const FaceTable& faces) {
  for (size_t f = 0; f < faces.size(); ++f)
    if (faces.emission[f] != faces.emission[0] || faces.reflectance[f] != faces.reflectance[0]) return false;
  return faces.size() > 0 && largest(faces.emission[0]) > 0 && is_closed(solution);
}

double find_furnace_error(const Solution& solution, const FaceTable& faces) {
  double error = 0;
  for (int channel = 0; channel < 3; ++channel) {
    double exact = 0;
    for (size_t bounce = 0; bounce <= solution.log.passes.size(); ++bounce)
      exact += double{faces.emission[0][channel]} *
               std::pow(double{faces.reflectance[0][channel]}, static_cast<double>(bounce));
    if (exact == 0) continue;
    for (size_t row = 0; row < solution.mesh.elements.size(); ++row)
      error = std::max(error, std::abs(solution.mesh.elements.radiosity[row][channel] / exact - 1));
  }
  return error;
}

}  // namespace

Times read_clocks() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return {std::chrono::duration<double>(now).count(),
          seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime)};
}

Times operator-(Times end, Times begin) { return {end.wall - begin.wall, end.processor - begin.processor}; }

Scene load_quietly(const std::string& path) {
  std::vector<Diagnostic> warnings;
  return load_scene(path, warnings);
}

SolverSettings settings_within(const Scene& scene, uint64_t max_patches) {
  SolverSettings settings = scene.solver;
  settings.patch_count_max = std::min(settings.patch_count_max, max_patches);
  const uint64_t start = count_starting_patches(scene.faces, settings);
  if (start > settings.patch_count_max)
    throw UserError("too-many-patches",
                    fmt::format("the scene starts with {} patches; the limit is {}; raise --max-patches",
                                start, settings.patch_count_max),
                    scene.file);
  return settings;
}

Solution solve_whole(std::shared_ptr<const Surfaces> surfaces, const SolverSettings& settings) {
  Solution solution = make_solution(std::move(surfaces), settings);
  while (refine(solution)) {
  }
  do advance(solution);
  while (!is_converged(solution) && solution.log.passes.size() < settings.pass_count_max);
  return solution;
}

std::optional<SolverSettings> settings_for_count(const FaceTable& faces, SolverSettings settings,
                                                 uint64_t count) {
  settings.patch_count_max = count;
  // The scene's area is about 1: no patch is longer than the one or smaller than the other.
  float low = 1e-5f, high = 10;
  settings.patch_size = high;
  if (count_starting_patches(faces, settings) > count / 2) return {};
  for (int step = 0; step < 40; ++step) {
    settings.patch_size = std::sqrt(low * high);
    (count_starting_patches(faces, settings) > count / 2 ? low : high) = settings.patch_size;
  }
  settings.patch_size = high;
  settings.patch_size_min = 0;  // the solver's own share of the starting size
  return settings;
}

std::optional<double> find_known_error(const Solution& solution, const Scene& scene) {
  if (is_furnace(solution, scene.faces)) return find_furnace_error(solution, scene.faces);
  std::optional<double> error;
  for (const Expectation& expectation : scene.expectations) {
    if (expectation.pass != solution.log.passes.size()) continue;
    const double exact = largest(expectation.radiosity);
    if (exact <= 0) continue;
    const DRgb difference = find_mean_radiosity(solution, scene, expectation) - DRgb(expectation.radiosity);
    for (int channel = 0; channel < 3; ++channel)
      error = std::max(error.value_or(0), std::abs(difference[channel]) / exact);
  }
  return error;
}

}  // namespace patchlight
