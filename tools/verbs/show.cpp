// The verb show: what the file, -D and --set left, with the flags over it.
#include "tools/verbs/show.h"

#include "tools/base/files.h"
#include "tools/base/flag_values.h"
#include "tools/render/plan.h"
#include "tools/verbs/flag_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Shows what a scene means once everything is put together; solves nothing.

Examples:
  patchlight show room.yaml --effective             every setting with its origin
  patchlight show room.yaml --effective -D w=8 --set solver.rays=64 --passes 4

Origins, the weaker first: built-in, FILE:LINE:COLUMN, -D and --set, other flags.
)";

void set(SettingTable& settings, size_t row, std::string value, std::string origin) {
  settings.value[row] = std::move(value);
  settings.origin[row] = std::move(origin);
}

// Sets the row of that path where the flag was given.
template <class Value>
void set_by_flag(SettingTable& settings, std::string_view path, bool given, const Value& value,
                 std::string_view flag) {
  if (!given) return;
  const auto found = std::find(settings.path.begin(), settings.path.end(), path);
  if (found == settings.path.end()) return;
  set(settings, static_cast<size_t>(found - settings.path.begin()), fmt::format("{}", value),
      std::string(flag));
}

std::string list_text(const std::vector<uint32_t>& numbers) {
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}

void erase_row(SettingTable& settings, size_t row) {
  const auto at = static_cast<ptrdiff_t>(row);
  settings.path.erase(settings.path.begin() + at);
  settings.value.erase(settings.value.begin() + at);
  settings.origin.erase(settings.origin.begin() + at);
}

// Keeps the asked camera's rows, and gives the asked size to all that are kept.
void merge_camera_flags(SettingTable& settings, const Options& options) {
  const std::string kept = "cameras." + options.camera + ".";
  for (size_t row = settings.size(); row-- > 0;) {
    const std::string& path = settings.path[row];
    if (!path.starts_with("camera")) continue;
    if (!options.camera.empty() && path.starts_with("cameras.") && !path.starts_with(kept))
      erase_row(settings, row);
    else if (options.size && path.ends_with(".size"))
      set(settings, row, fmt::format("[{}, {}]", (*options.size)[0], (*options.size)[1]), "--size");
  }
}

}  // namespace

SettingTable merge_flags(const Scene& scene, const Options& options) {
  SettingTable settings = scene.settings;
  const SolverSettings& solver = scene.solver;
  const OutputSettings& output = scene.output;
  const std::vector<uint32_t> snapshots =
      pick_snapshots(output.snapshots, options.snapshots_all, solver.pass_count_max);
  set_by_flag(settings, "solver.passes", options.passes.has_value(), solver.pass_count_max, "--passes");
  set_by_flag(settings, "solver.rays", options.rays.has_value(), solver.rays, "--rays");
  set_by_flag(settings, "solver.seed", options.seed.has_value(), solver.seed, "--seed");
  set_by_flag(settings, "solver.max_patches", options.max_patches.has_value(), solver.patch_count_max,
              "--max-patches");
  set_by_flag(settings, "output.snapshots", output.snapshots.empty(), list_text(snapshots), "built-in");
  set_by_flag(settings, "output.snapshots", options.snapshots_all || !options.snapshots.empty(),
              list_text(snapshots), "--snapshots");
  set_by_flag(settings, "output.exposure", options.exposure_auto, "auto", "--exposure");
  set_by_flag(settings, "output.exposure", options.exposure_ev.has_value(), output.exposure_ev.value_or(0),
              "--exposure");
  set_by_flag(settings, "output.shading", options.shading.has_value(),
              output.shading == Shading::kFlat ? "flat" : "smooth", "--shading");
  set_by_flag(settings, "output.basename", output.basename.empty(), pick_stem(scene.file, ""),
              "built-in: the scene file's name");
  merge_camera_flags(settings, options);
  return settings;
}

void describe_show(Usage& usage, Options& options) {
  usage.help = kHelp;
  bool& effective = options.own.emplace<ShowOptions>().effective;
  add_common_flags(usage, options);
  add_look_flags(usage, options);
  add_switch(usage, "--effective", effective, "the merged settings with their origins");
  usage.checks.push_back([&effective] {
    if (!effective) fail_usage("show: say what: --effective shows the merged settings");
  });
}

int show(const Options& options, Talk& talk) {
  if (!options.json) check_standard_output();
  std::vector<Diagnostic> warnings;
  Scene scene = load_scene(options.scene, warnings, options.load);
  say_diagnostics(talk, warnings);
  make_plan(scene, options);
  if (options.json) return 0;
  const SettingTable settings = merge_flags(scene, options);
  size_t path_width = 0, value_width = 0;
  for (size_t row = 0; row < settings.size(); ++row) {
    path_width = std::max(path_width, settings.path[row].size());
    value_width = std::max(value_width, std::min<size_t>(settings.value[row].size(), 40));
  }
  std::string text;
  for (size_t row = 0; row < settings.size(); ++row)
    text += fmt::format("{:{}}  {:{}}  {}\n", settings.path[row], path_width, settings.value[row],
                        value_width, settings.origin[row]);
  print_result(text);
  return 0;
}

}  // namespace patchlight
