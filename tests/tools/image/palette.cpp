// Pictures of 256 colours.
#include "tools/image/palette.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace patchlight;

namespace {

// A wall that grows brighter to the right and redder downwards.
BytePicture make_wall(uint32_t width, uint32_t height) {
  BytePicture picture{width, height, {}};
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const double grey = 40 + 180.0 * x / width, tint = 30.0 * y / height;
      picture.pixels.push_back({static_cast<uint8_t>(grey + tint), static_cast<uint8_t>(grey),
                                static_cast<uint8_t>(grey - tint / 2)});
    }
  return picture;
}

}  // namespace

TEST_CASE("few colours are kept as they are") {
  BytePicture picture{
      3, 2, {{0, 0, 0}, {255, 255, 255}, {200, 10, 10}, {200, 10, 10}, {0, 0, 0}, {9, 99, 199}}};
  const Palette palette = pick_palette(picture);
  CHECK(palette.size() == 4);
  const std::vector<uint8_t> indices = index_pixels(picture, palette);
  REQUIRE(indices.size() == 6);
  for (size_t k = 0; k < 6; ++k) CHECK(palette[indices[k]] == picture.pixels[k]);
}

TEST_CASE("many colours become 256, and means over small areas stay what they were") {
  const BytePicture picture = make_wall(240, 160);
  const Palette palette = pick_palette(picture);
  CHECK(palette.size() == 256);
  const std::vector<uint8_t> indices = index_pixels(picture, palette);
  double inner = 0, border = 0;
  for (uint32_t y = 0; y < 160; y += 8)
    for (uint32_t x = 0; x < 240; x += 8)
      for (size_t c = 0; c < 3; ++c) {
        double before = 0, after = 0;
        for (uint32_t k = 0; k < 64; ++k) {
          const size_t pixel = (y + k / 8) * 240 + x + k % 8;
          before += picture.pixels[pixel][c] / 64.0;
          after += palette[indices[pixel]][c] / 64.0;
        }
        double& largest = x < 16 || y < 16 || x >= 224 || y >= 144 ? border : inner;
        largest = std::max(largest, std::abs(before - after));
      }
  // 256 colours share 180 levels by 30: they lie some 5 apart. What the 16 pixels along two sides of a tile
  // lack, half of that each, is carried out of it, and as much comes in: 16 * 2.5 / 64 if all had one sign.
  // No colour lies beyond those at the border of the picture, so that there half a step may stay in each
  // direction.
  CHECK(inner < 1);
  CHECK(border < 5);
}

TEST_CASE("an empty or even picture has a palette of one colour") {
  CHECK(pick_palette({}).size() == 1);
  BytePicture even{4, 4, std::vector<std::array<uint8_t, 3>>(16, {7, 8, 9})};
  CHECK(pick_palette(even) == Palette{{7, 8, 9}});
}
