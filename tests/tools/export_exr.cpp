// Radiosity to OpenEXR and back.
#include "tools/exporters.h"

#include <doctest/doctest.h>
#include <tinyexr.h>

#include <cstdlib>

using namespace patchlight;

TEST_CASE("an EXR keeps every float, in the order R, G, B, the first row at the top") {
  Picture picture{3, 2, {}};
  for (int k = 0; k < 6; ++k)
    picture.pixels.emplace_back(0.1f + static_cast<float>(k), 16000.5f * static_cast<float>(k), 1e-7f);
  const std::string file = encode_exr(picture);
  float* pixels = nullptr;
  int width = 0, height = 0;
  const char* error = nullptr;
  REQUIRE(LoadEXRFromMemory(&pixels, &width, &height, reinterpret_cast<const unsigned char*>(file.data()),
                            file.size(), &error) == TINYEXR_SUCCESS);
  CHECK(width == 3);
  CHECK(height == 2);
  for (size_t k = 0; k < 6; ++k) {
    CHECK(pixels[4 * k] == picture.pixels[k].r);
    CHECK(pixels[4 * k + 1] == picture.pixels[k].g);
    CHECK(pixels[4 * k + 2] == picture.pixels[k].b);
  }
  std::free(pixels);
}
