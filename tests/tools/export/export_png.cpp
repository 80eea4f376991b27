// Pixels to PNG and back.
#include "tools/export/exporters.h"

#include <doctest/doctest.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#include <stb_image.h>

using namespace patchlight;

namespace {

std::vector<unsigned char> decode(const std::string& file, int& width, int& height) {
  int channels = 0;
  unsigned char* bytes = stbi_load_from_memory(reinterpret_cast<const unsigned char*>(file.data()),
                                               static_cast<int>(file.size()), &width, &height, &channels, 3);
  REQUIRE(bytes != nullptr);
  std::vector<unsigned char> pixels(bytes, bytes + 3 * width * height);
  stbi_image_free(bytes);
  return pixels;
}

}  // namespace

TEST_CASE("a PNG holds sRGB: black is 0, white is 255, linear 0.2140 is half way") {
  Picture picture{16, 8, std::vector<Rgb>(128, Rgb(0, 1, 0.21404f))};
  int width = 0, height = 0;
  const std::vector<unsigned char> pixels =
      decode(find_exporter("png").encode_picture(picture), width, height);
  CHECK(width == 16);
  CHECK(height == 8);
  double mean = 0;
  for (size_t k = 0; k < pixels.size(); k += 3) {
    CHECK(pixels[k] == 0);
    CHECK(pixels[k + 1] == 255);
    mean += pixels[k + 2] / 128.0;
  }
  // The dither spreads 127.5 over 127 and 128; over whole 8 x 8 tiles its mean is exact to 1 / 128.
  CHECK(mean == doctest::Approx(127.5).epsilon(0.0002));
}

TEST_CASE("pixels outside 0..1 are clipped, and the first row is the top one") {
  Picture picture{1, 2, {Rgb(-1, 0, 0), Rgb(7, 7, 7)}};
  int width = 0, height = 0;
  const std::vector<unsigned char> pixels =
      decode(find_exporter("png").encode_picture(picture), width, height);
  CHECK(pixels[0] == 0);
  CHECK(pixels[3] == 255);
}
