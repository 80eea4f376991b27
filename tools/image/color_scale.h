// Numbers -> colours, and the legend that says which is which.
#pragma once

#include "engine/base/parallel.h"
#include "tools/base/look.h"
#include "tools/image/picture.h"

#include <span>
#include <string>
#include <vector>

namespace patchlight {

// A continuous scale from low to high, or a row of named classes.
struct ColorScale {
  std::string title = {};
  double low = 0, high = 1;  // log: both > 0
  bool log = false;
  std::vector<std::string> classes = {};  // not empty: value k has the colour of class k
};

// The colour map viridis (van der Walt, Smith: A Better Default Colormap for Matplotlib, 2015): even steps
// look even, also in grey. 0..1 to display-linear; what lies outside has the colour of the end.
Rgb map_viridis(double t);

// Where a value lies on the scale, 0..1, clipped.
double find_position(const ColorScale& scale, double value);
Rgb find_color(const ColorScale& scale, double value);

// Values of what is seen and is no lamp, W/m2, to a scale that holds them. Its ends are round numbers: the
// top is the brightest of all, lamps included, unless that is more than ten times what 99.5 % of the values
// stay below; the bottom is what 1 % stay below, but at least a ten thousandth of the top. Automatic scales
// go by decades where the ends are more than 20 to 1 apart; linear ones start at 0 unless all values are far
// from it. Reorders its input.
ColorScale pick_radiosity_scale(std::span<float> values, double brightest, ScaleKind kind);
// The scale for what passes add: four decades from the top of the radiosity scale downwards, or from 0.
ColorScale make_added_scale(const ColorScale& radiosity, ScaleKind kind);

// Colours of `count` values. What is not a number is magenta.
template <class Value>
std::vector<Rgb> color_values(const ColorScale& scale, size_t count, const Value& value) {
  std::vector<Rgb> colors(count);
  for_rows(count, 4096, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) colors[k] = find_color(scale, value(k));
  });
  return colors;
}
// Colours of the luminances of light.
std::vector<Rgb> color_luminances(const ColorScale& scale, std::span<const Rgb> light);

// Numbers along a continuous scale to write beside it, ascending.
std::vector<double> find_ticks(const ColorScale& scale);
// A number of the scale as people write it: 0.02, 1500, 2e-5.
std::string format_tick(double value);

// Draws the scale with its title and numbers into the box: a legend, in letters of that size and colour.
void draw_scale(Picture& picture, const Box& box, const ColorScale& scale, float letter_size,
                Rgb letter_color);
// Draws it on a dark ground at the lower left; pictures under 160 x 120 pixels have no room for it.
void draw_legend(Picture& picture, const ColorScale& scale);

}  // namespace patchlight
