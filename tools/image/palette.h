// Pictures of 8-bit sRGB -> pictures of 256 colours, for formats that have no more.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

// Red, green, blue of every pixel, row by row from the top left.
struct BytePicture {
  uint32_t width = 0, height = 0;
  std::vector<std::array<uint8_t, 3>> pixels;
};

using Palette = std::vector<std::array<uint8_t, 3>>;

// At most 256 colours, more of them where the picture has more pixels and more differences (Heckbert: Color
// Image Quantization for Frame Buffer Display, 1982).
Palette pick_palette(const BytePicture& picture);

// The index of a colour for every pixel. What a pixel's colour lacks is given to its neighbours (Floyd,
// Steinberg: An Adaptive Algorithm for Spatial Greyscale, 1976), so that smooth walls stay smooth.
std::vector<uint8_t> index_pixels(const BytePicture& picture, const Palette& palette);

}  // namespace patchlight
