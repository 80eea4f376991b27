// The verb check: everything that render does before it takes memory.
#include "tools/base/files.h"
#include "tools/base/format.h"
#include "tools/base/memory.h"
#include "tools/base/talk.h"
#include "tools/render/plan.h"
#include "tools/verbs/flag_groups.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Reads a scene, says what is wrong with it, counts it and forecasts its memory; solves nothing.

Examples:
  patchlight check room.yaml
  patchlight check room.yaml --json                 the messages as a JSON list, for editors
)";

}  // namespace

void describe_check(Usage& usage, Options& options) {
  usage.help = kHelp;
  add_common_flags(usage, options);
  add_method_flags(usage, options);
}

int check(const Options& options, Talk& talk) {
  if (!options.json) check_standard_output();
  std::vector<Diagnostic> warnings;
  Scene scene = load_scene(options.scene, warnings, options.load);
  say_diagnostics(talk, warnings);
  const Plan plan = make_plan(scene, options);
  check_limits(scene, plan);
  if (options.json) return 0;

  const RunForecast forecast = forecast_run(scene, plan);
  std::string text = fmt::format(
      "{}: {}\n"
      "polygons          {}\n"
      "faces             {}\n"
      "starting patches  {} of {} at most\n"
      "memory            likely {}, at most {}; {} available\n"
      "time              likely {} on {} thread{}; an estimate by counts of rays\n",
      escape_text(scene.file, 200),
      warnings.empty()
          ? "right"
          : fmt::format("right, with {} warning{}", warnings.size(), warnings.size() > 1 ? "s" : ""),
      scene.polygons.size(), scene.faces.size(), plan.starting_patches, scene.solver.patch_count_max,
      format_bytes(forecast.bytes), format_bytes(forecast.bytes_most), format_bytes(find_memory_available()),
      format_seconds(forecast.seconds), plan.thread_count, plan.thread_count == 1 ? "" : "s");
  for (const Camera& camera : plan.cameras)
    text += fmt::format("camera            {}{}{} x {}\n", camera.name, camera.name.empty() ? "" : ", ",
                        camera.width, camera.height);
  print_result(text);
  return 0;
}

}  // namespace patchlight
