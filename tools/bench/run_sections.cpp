// The sections that were asked for, one after the other. Each measures in child processes; this only reads,
// prints and writes.
#include "dsl/scene/load.h"
#include "engine/base/parallel.h"
#include "engine/trace/tracer.h"
#include "tools/base/files.h"
#include "tools/base/flag_values.h"
#include "tools/base/format.h"
#include "tools/base/memory.h"
#include "tools/base/stop.h"
#include "tools/base/version.h"
#include "tools/bench/figure.h"
#include "tools/bench/sections.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

namespace patchlight {
namespace {

constexpr int kExitOurMistake = 70;

// Whole rooms of different kinds, few and always the same, so that figures of two builds compare. The
// lecture's room is first: kernels, growth and threads take that one.
constexpr const char* kUsualScenes[] = {"pillar_room", "cornell_box", "furnace",     "furniture",
                                        "hall",        "l_room",      "view_factors"};

struct Section {
  const char* name;
  Json (*measure)(const BenchOptions&, Talk&);
  std::string (*format)(const Json&);
};
constexpr Section kSections[] = {
    {"kernels", measure_kernels_section, format_kernels}, {"scenes", measure_scenes, format_scenes},
    {"loading", measure_loading, format_loading},         {"growth", measure_growth, format_growth},
    {"threads", measure_threads, format_threads},
};

// The usual scenes that are here.
std::vector<std::string> find_scenes() {
  std::vector<std::string> scenes;
  for (const char* name : kUsualScenes) {
    const std::string path = fmt::format("scenes/{}.yaml", name);
    std::error_code error;
    if (std::filesystem::exists(path, error)) scenes.push_back(path);
  }
  if (scenes.empty())
    throw UserError("usage",
                    fmt::format("there is no scenes/{}.yaml here; name scene files", kUsualScenes[0]));
  return scenes;
}

Json describe_machine() {
  return {{"processor", processor_name()},
          {"cores", thread_count_default()},
          {"memory_bytes", uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGE_SIZE))},
          {"compiler", compiler_version()},
          {"build", build_type()},
          {"tracer", tracer_version()},
          {"tbb", tbb_version()},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))}};
}

std::string format_machine(const Json& machine) {
  return fmt::format("patchlight {} on {}, {} cores, {}; {}, {}; {}, oneTBB {}; {}\n", version_number(),
                     machine["processor"].get<std::string>(), machine["cores"].get<size_t>(),
                     format_bytes(machine["memory_bytes"].get<uint64_t>()),
                     machine["compiler"].get<std::string>(), machine["build"].get<std::string>(),
                     machine["tracer"].get<std::string>(), machine["tbb"].get<std::string>(),
                     machine["date"].get<std::string>());
}

std::string format_noise(const Noise& noise) {
  if (noise.noisy_count == 0)
    return fmt::format("all {} figures spread by less than 10 %\n", noise.figure_count);
  return fmt::format(
      "{} of {} figures spread by more than 10 %: a noisy machine; compare medians with care\n",
      noise.noisy_count, noise.figure_count);
}

// Prints each section as soon as it is measured.
Json measure_sections(const BenchOptions& asked, Talk& talk) {
  Json result = {{"patchlight", version_number()}, {"machine", describe_machine()}};
  print_result(format_machine(result["machine"]));
  for (const Section& section : kSections) {
    if (std::find(asked.sections.begin(), asked.sections.end(), section.name) == asked.sections.end())
      continue;
    result[section.name] = section.measure(asked, talk);
    say_progress_done(talk);
    print_result(section.format(result[section.name]));
  }
  const Noise noise = find_noise(result);
  result["noise"] = {{"figures", noise.figure_count}, {"spread_over_10_percent", noise.noisy_count}};
  print_result(format_noise(noise));
  return result;
}

}  // namespace

int run_sections(BenchOptions asked, Talk& talk) {
  check_standard_output();
  if (!asked.json.empty()) check_file_writable(asked.json);
  if (asked.scenes.empty()) asked.scenes = find_scenes();
  if (asked.threads == 0) asked.threads = thread_count_default();
  for (const std::string& scene : asked.scenes) {
    std::vector<Diagnostic> warnings;
    load_scene(scene, warnings);  // mistakes come out before the work
    say_diagnostics(talk, warnings);
  }

  const StopSignals signals(*current_workers());  // From here on there may be folders to clean up.
  try {
    const Json result = measure_sections(asked, talk);
    if (!asked.json.empty()) write_file(asked.json, format_json(result));
    const bool same = !result.contains("threads") || result["threads"]["same"].get<bool>();
    return same ? 0 : kExitOurMistake;
  } catch (const Cancelled&) {
    say(talk, "stopped by a signal; nothing is written");
    return 128 + stop_signal();
  }
}

}  // namespace patchlight
