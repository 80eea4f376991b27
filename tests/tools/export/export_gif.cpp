// Frames to GIF, and back by another decoder.
#include "tools/export/exporters.h"

#include <doctest/doctest.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_GIF
#include <stb_image.h>

#include <cstdlib>

using namespace patchlight;

TEST_CASE("a GIF holds its frames one after another, each for its time, and repeats") {
  Animation animation;
  for (int frame = 0; frame < 3; ++frame) {
    Picture picture = make_picture(40, 30, Rgb(0));
    fill_box(picture, {10u * static_cast<uint32_t>(frame + 1), 25, 3, 3}, Rgb(1));
    add_frame(animation, picture, "", frame == 2 ? 3 : 0.5);
  }
  const std::string file = find_exporter("gif").encode_animation(animation);
  CHECK(file.starts_with("GIF89a"));
  CHECK(file.find("NETSCAPE2.0") != std::string::npos);
  CHECK(file.back() == 0x3b);
  int* delays = nullptr;
  int width = 0, height = 0, count = 0, channels = 0;
  unsigned char* bytes = stbi_load_gif_from_memory(reinterpret_cast<const unsigned char*>(file.data()),
                                                   static_cast<int>(file.size()), &delays, &width, &height,
                                                   &count, &channels, 3);
  REQUIRE(bytes != nullptr);
  CHECK(width == 40);
  CHECK(height == 30);
  REQUIRE(count == 3);
  for (int frame = 0; frame < 3; ++frame) {
    CHECK(delays[frame] == (frame == 2 ? 3000 : 500));
    const unsigned char* row = bytes + (frame * 30 + 26) * 40 * 3;
    for (int x = 0; x < 40; ++x) {
      const bool white = x >= 10 * (frame + 1) && x < 10 * (frame + 1) + 3;
      CHECK(int(row[3 * x]) == (white ? 255 : 0));
    }
  }
  stbi_image_free(bytes);
  std::free(delays);
}

TEST_CASE("frames wider than 960 pixels are made smaller, and labels are drawn into them") {
  Animation animation;
  add_frame(animation, make_picture(1920, 1080, Rgb(0.2f)), "pass 1", 1);
  REQUIRE(animation.frames.size() == 1);
  CHECK(animation.frames[0].width == 960);
  CHECK(animation.frames[0].height == 540);
  const auto& pixels = animation.frames[0].pixels;
  CHECK(pixels[20 * 960 + 20] != pixels[400 * 960 + 400]);
  // Linear 0.2 is 124 in sRGB.
  CHECK(int(pixels[400 * 960 + 400][1]) == 124);
}
