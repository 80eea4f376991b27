// One colour a pixel, and what drawings need to do with pictures.
#pragma once

#include "engine/base/vector.h"

#include <cstdint>
#include <string>
#include <vector>

namespace patchlight {

// What else a format may hold of each pixel: values or whole numbers.
struct Channel {
  std::string name;
  std::vector<float> values;
  std::vector<uint32_t> numbers;
};

// Row by row from the top left.
struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<Rgb> pixels;
  std::vector<Channel> channels = {};
};

// Pixels from the top left.
struct Box {
  uint32_t x = 0, y = 0, width = 0, height = 0;
};

Picture make_picture(uint32_t width, uint32_t height, Rgb color);

// Blends a colour into the box; what lies outside of the picture is left out.
void fill_box(Picture& picture, const Box& box, Rgb color, float opacity = 1);

// Copies `part` into the picture, its top left at (x, y); what lies outside is left out.
void place_picture(Picture& picture, const Picture& part, uint32_t x, uint32_t y);

// The picture at another size, none larger: means over the area of each new pixel.
Picture shrink_picture(const Picture& picture, uint32_t width, uint32_t height);

// `color` over `ground`, both display-linear, mixed as the eye sees them (square roots of light, near to the
// transfer curve of displays), so that dark letters on light ground are as heavy as light ones on dark.
Rgb mix_seen(Rgb ground, Rgb color, float share);

}  // namespace patchlight
