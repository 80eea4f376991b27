// Radiosity to Radiance HDR and back.
#include "tools/export/exporters.h"

#include <doctest/doctest.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_HDR
#include <stb_image.h>

#include <cmath>
#include <limits>

using namespace patchlight;

TEST_CASE("an HDR keeps radiosity within its 8 bits, the first row at the top") {
  Picture picture = make_picture(9, 2, Rgb(0));
  for (size_t k = 0; k < picture.pixels.size(); ++k) {
    const float value = std::exp2(static_cast<float>(k) - 6) * 1.37f;
    picture.pixels[k] = Rgb(value, 0.6f * value, 0.9f * value);
  }
  picture.pixels[17] = Rgb(std::numeric_limits<float>::quiet_NaN(), -1, 1e5f);
  const std::string file = find_exporter("hdr").encode_picture(picture);
  int width = 0, height = 0, channels = 0;
  float* values = stbi_loadf_from_memory(reinterpret_cast<const unsigned char*>(file.data()),
                                         static_cast<int>(file.size()), &width, &height, &channels, 3);
  REQUIRE(values != nullptr);
  CHECK(width == 9);
  CHECK(height == 2);
  for (size_t k = 0; k < 17; ++k)
    for (int c = 0; c < 3; ++c)
      // A step is a 128th of the largest channel at most, and is cut off.
      CHECK(std::abs(values[3 * k + static_cast<size_t>(c)] - picture.pixels[k][c]) <=
            picture.pixels[k].r / 128);
  CHECK(values[3 * 17] == 0);
  CHECK(values[3 * 17 + 1] == 0);
  CHECK(values[3 * 17 + 2] == doctest::Approx(1e5).epsilon(1 / 128.0));
  stbi_image_free(values);
}
