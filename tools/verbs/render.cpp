// The flags of the verb render. What it does stands in render.cpp of the folder render.
#include "tools/render/render.h"

#include "dsl/report/diagnostics.h"
#include "tools/base/flag_values.h"
#include "tools/export/exporters.h"
#include "tools/image/false_colors.h"
#include "tools/verbs/flag_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Solves a scene and writes pictures, and a report, while it goes.

Examples:
  patchlight render room.yaml                       pictures after passes 1, 2 and 16 into out/
  patchlight render room.yaml --passes 4 --snapshots all --size 640x480
  patchlight render room.yaml -D w=8 --set solver.threshold=0.05
  patchlight render room.yaml --camera door --exposure -3.5 --mesh
  patchlight render room.yaml --storyboard --animation passes,rounds     for slides
  patchlight render room.yaml --false-color radiosity                    W/m2 as colours, with a legend
  patchlight render room.yaml --format exr,csv      numbers instead of pictures
  generate_scene | patchlight render - -o lit       a scene from standard input

Flags are stronger than the scene file. The paths of the files are the lines on standard output.
)";

// "png,csv": names of exporters, repeats dropped.
std::vector<std::string> parse_formats(std::string_view text) {
  const std::vector<std::string> known = exporter_formats();
  std::vector<std::string> formats;
  for (const std::string& part : split_list(text)) {
    if (std::find(known.begin(), known.end(), part) == known.end())
      fail_usage(fmt::format("--format: '{}' is not a format{}; known: {}", escape_text(part),
                             hint(part, known), fmt::join(known, ", ")));
    if (std::find(formats.begin(), formats.end(), part) == formats.end()) formats.push_back(part);
  }
  return formats;
}

// Flags of looks that do not go together are never ignored.
void check_look_flags(const Options& options) {
  const Look& look = options.look;
  const FalseColor* color = look.false_color;
  if (color != nullptr && look.tone != nullptr) fail_usage("--tone: false colours have none");
  if (color != nullptr && !color->of_light && look.light != Light::kAll)
    fail_usage(fmt::format("--light: false colours of {} know no parts of the light", color->name));
  const bool scaled = (color != nullptr && color->has_scale) || options.storyboard;
  if (look.scale == ScaleKind::kAuto || scaled) return;
  std::vector<std::string_view> names;
  for (const FalseColor& row : false_colors())
    if (row.has_scale) names.push_back(row.name);
  fail_usage(
      fmt::format("--scale: only {} in false colours, and storyboards, have one", fmt::join(names, " and ")));
}

}  // namespace

void describe_render(Usage& usage, Options& options) {
  usage.help = kHelp;
  RenderOptions& own = options.own.emplace<RenderOptions>();
  add_common_flags(usage, options);
  add_method_flags(usage, options);
  add_look_flags(usage, options);
  add_out_flag(usage, options);
  add_switch(usage, "--mesh", options.mesh, "draw the borders of the patches");
  add_choice(usage, "--light", kLightNames,
             "direct: emission and the light of pass 1; indirect: what later passes added; all unless given",
             [&](size_t choice) { options.look.light = static_cast<Light>(choice); });
  add_tone_flag(usage, options);
  std::vector<std::string_view> colors;
  for (const FalseColor& color : false_colors()) colors.push_back(color.help);
  const std::vector<std::string> names = false_color_names();
  add_choice(
      usage, "--false-color", names,
      fmt::format("numbers as colours with a legend: {}", fmt::join(colors, ", ")),
      [&options, names](size_t choice) { options.look.false_color = find_false_color(names[choice]); });
  add_switch(usage, "--storyboard", options.storyboard,
             "the snapshots side by side, with labels, and below what was added from one to the next");
  add_value(
      usage, "--animation", "passes|rounds|shots,...",
      "GIFs of all passes, of the rounds of refinement, of the pictured shots", [&](const std::string& text) {
        bool* const asked[] = {&options.animate_passes, &options.animate_rounds, &options.animate_shots};
        for (const std::string& series : split_list(text))
          *asked[parse_choice("--animation", series, {"passes", "rounds", "shots"})] = true;
      });
  add_choice(usage, "--scale", kScaleNames, "of false colours in W/m2; auto unless given",
             [&](size_t choice) { options.look.scale = static_cast<ScaleKind>(choice); });
  add_value(usage, "--format", fmt::format("{},...", fmt::join(exporter_formats(), "|")),
            "files to write; png unless given",
            [&](const std::string& text) { options.formats = parse_formats(text); });
  add_value(usage, "--report", "FILE", "where the report goes; beside the pictures unless given",
            [&](const std::string& text) {
              if (text.empty()) fail_usage("--report: expected a file");
              own.report = text;
            });
  add_switch(usage, "--require-convergence", own.require_convergence,
             "exit code 6 where the passes end before `until` is reached");
  usage.checks.push_back([&options] { check_look_flags(options); });
}

}  // namespace patchlight
