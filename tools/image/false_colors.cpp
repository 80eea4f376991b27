// The table of false colours.
#include "tools/image/false_colors.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

ColorScale keep_scale(const ColorScale& radiosity, ScaleKind, const PatchTable&) { return radiosity; }

std::vector<Rgb> color_light(const ColorScale& scale, const ColorSource& source) {
  return color_luminances(scale, source.lit);
}

ColorScale make_residual_scale(const ColorScale& radiosity, ScaleKind kind, const PatchTable&) {
  return make_added_scale(radiosity, kind);
}

std::vector<Rgb> color_residual(const ColorScale& scale, const ColorSource& source) {
  return color_luminances(scale, find_added(source.history));
}

ColorScale make_level_scale(const ColorScale&, ScaleKind, const PatchTable& elements) {
  ColorScale scale{.title = "times that a patch's polygon was halved"};
  const uint8_t most =
      elements.size() == 0 ? 0 : *std::max_element(elements.level.begin(), elements.level.end());
  for (uint32_t level = 0; level <= most; ++level) scale.classes.push_back(fmt::format("{}", level));
  return scale;
}

std::vector<Rgb> color_levels(const ColorScale& scale, const ColorSource& source) {
  const std::vector<uint8_t>& levels = source.solution.mesh.elements.level;
  return color_values(scale, levels.size(), [&](size_t k) { return double(levels[k]); });
}

ColorScale make_reason_scale(const ColorScale&, ScaleKind, const PatchTable&) {
  return {.title = "why patches were split",
          .classes = {"start", "direct light", "indirect light", "balance"}};
}

std::vector<Rgb> color_reasons(const ColorScale& scale, const ColorSource& source) {
  const std::vector<SplitReason>& reasons = source.solution.mesh.reasons;
  return color_values(scale, reasons.size(), [&](size_t k) { return static_cast<double>(reasons[k]); });
}

constexpr FalseColor kFalseColors[] = {
    {.name = "radiosity",
     .help = "radiosity",
     .of_light = true,
     .has_scale = true,
     .make_scale = keep_scale,
     .find_colors = color_light},
    {.name = "residual",
     .help = "what the last pass added",
     .of_passes = true,
     .has_scale = true,
     .make_scale = make_residual_scale,
     .find_colors = color_residual},
    {.name = "level",
     .help = "how often a patch was halved",
     .of_patches = true,
     .make_scale = make_level_scale,
     .find_colors = color_levels},
    {.name = "reason",
     .help = "why it was split",
     .of_patches = true,
     .make_scale = make_reason_scale,
     .find_colors = color_reasons},
};

}  // namespace

std::span<const FalseColor> false_colors() { return kFalseColors; }

const FalseColor* find_false_color(std::string_view name) {
  for (const FalseColor& color : kFalseColors)
    if (color.name == name) return &color;
  return nullptr;
}

std::vector<std::string> false_color_names() {
  std::vector<std::string> names = {"off"};
  for (const FalseColor& color : kFalseColors) names.emplace_back(color.name);
  return names;
}

}  // namespace patchlight
