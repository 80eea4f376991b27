// What pictures may show in false colours: one row a kind.
#pragma once

#include "engine/solve/solve.h"
#include "tools/image/color_scale.h"
#include "tools/image/light_parts.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

// What a run knows when it is pictured.
struct ColorSource {
  const Solution& solution;
  std::span<const Rgb> lit;  // the part of the light that pictures show, at the values of the films
  const LightHistory& history;
};

struct FalseColor {
  std::string_view name;
  std::string_view help;    // in a list of them all
  bool of_patches = false;  // it belongs to patches; else it is known at their corners, too
  bool of_light = false;    // it shows ColorSource::lit, so that --light chooses among its parts
  bool of_passes = false;   // it shows what single passes add, at the cost of keeping the light of two
  bool has_scale = false;   // it has a scale of W/m2 that --scale divides
  // From the scale of radiosity, which holds all that is seen.
  ColorScale (*make_scale)(const ColorScale& radiosity, ScaleKind kind, const PatchTable& elements);
  // A row a value of the films.
  std::vector<Rgb> (*find_colors)(const ColorScale& scale, const ColorSource& source);
};

std::span<const FalseColor> false_colors();
// None for off.
const FalseColor* find_false_color(std::string_view name);
// Their names on the command line, off first.
std::vector<std::string> false_color_names();

}  // namespace patchlight
