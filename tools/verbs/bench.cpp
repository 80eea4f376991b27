// The verb bench: its flags. bench/run_sections.cpp does the work, in builds that have it.
#include "tools/base/flag_values.h"
#include "tools/bench/sections.h"
#include "tools/verbs/flag_groups.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Measures this build on this machine: kernels beside bare Embree and bare memory, and whole runs of scenes.

Examples:
  patchlight bench                                  kernels, and the scenes of the folder scenes
  patchlight bench room.yaml --only scenes          whole runs of one scene
  patchlight bench --only loading                   large scenes, beside the YAML parser alone
  patchlight bench --only growth,threads --json b.json

Every figure is a median with its lowest and highest value. Kernels, growth and threads take the first scene.
)";

// They are read more than once.
void check_bench_scenes(const std::vector<std::string>& scenes) {
  for (const std::string& scene : scenes)
    if (scene.empty() || scene == "-")
      fail_usage(fmt::format("bench: found '{}', expected the path of a scene file", scene));
}

}  // namespace

void describe_bench(Usage& usage, Options& options) {
  usage.help = kHelp;
  BenchOptions& bench = options.own.emplace<BenchOptions>();
  usage.argument = {
      .name = "SCENE", .help = "scene files; seven rooms of scenes/ unless given", .list = &bench.scenes};
  add_value(usage, "--only", "kernels|scenes|loading|growth|threads,...",
            "sections; the first two unless given", [&bench](const std::string& text) {
              bench.sections = split_list(text);
              for (const std::string& section : bench.sections)
                parse_choice("--only", section, {"kernels", "scenes", "loading", "growth", "threads"});
            });
  add_value(usage, "--json", "FILE", "the result as JSON, too", [&bench](const std::string& text) {
    if (text.empty()) fail_usage("--json: expected a file");
    bench.json = text;
  });
  add_value(
      usage, "--repetitions", "N", "runs of everything; 5 unless given",
      [&bench](const std::string& text) { bench.repetitions = parse_count("--repetitions", text, 1, 1000); });
  add_value(
      usage, "--seconds", "S", "at least so long a repetition of a kernel; 0.2 unless given",
      [&bench](const std::string& text) { bench.seconds = parse_number("--seconds", text, 0.001, 100); });
  add_value(
      usage, "--threads", "N", "at most so many; all cores unless given",
      [&bench](const std::string& text) { bench.threads = parse_count("--threads", text, 1, kThreadsMax); });
  add_value(usage, "--max-patches", "N", "no measured mesh has more patches",
            [&bench](const std::string& text) {
              bench.max_patches = parse_count("--max-patches", text, 1, 1'000'000'000);
            });
  add_value(usage, "--max-memory", "BYTES", "growth stops before a mesh that may need more",
            [&bench](const std::string& text) { bench.max_memory = parse_bytes("--max-memory", text); });
  add_switch(usage, "--quiet", options.quiet, "no progress");
  usage.checks.push_back([&bench] { check_bench_scenes(bench.scenes); });
}

int bench(const Options& options, Talk& talk) { return run_sections(get_own<BenchOptions>(options), talk); }

}  // namespace patchlight
