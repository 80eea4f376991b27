// Radiosity to OpenEXR and back.
#include "tools/export/exporters.h"

#include <doctest/doctest.h>
#include <tinyexr.h>

#include <cstdlib>
#include <limits>

using namespace patchlight;

TEST_CASE("an EXR keeps every float, in the order R, G, B, the first row at the top") {
  Picture picture{3, 2, {}};
  for (int k = 0; k < 6; ++k)
    picture.pixels.emplace_back(0.1f + static_cast<float>(k), 16000.5f * static_cast<float>(k), 1e-7f);
  const std::string file = find_exporter("exr").encode_picture(picture);
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

TEST_CASE("an EXR holds the picture's channels, numbers as numbers, in the order of their names") {
  Picture picture{2, 2, std::vector<Rgb>(4, Rgb(1, 2, 3))};
  picture.channels = {{"direct.R", {0.5f, 1.5f, 2.5f, 3.5f}, {}},
                      {"Z", {1, 2, std::numeric_limits<float>::infinity(), 4}, {}},
                      {"id", {}, {1, 16'777'217, 0, 4'000'000'000}}};
  const std::string file = find_exporter("exr").encode_picture(picture);
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  EXRVersion version;
  EXRHeader header;
  InitEXRHeader(&header);
  EXRImage image;
  InitEXRImage(&image);
  const char* error = nullptr;
  REQUIRE(ParseEXRVersionFromMemory(&version, bytes, file.size()) == TINYEXR_SUCCESS);
  REQUIRE(ParseEXRHeaderFromMemory(&header, &version, bytes, file.size(), &error) == TINYEXR_SUCCESS);
  REQUIRE(LoadEXRImageFromMemory(&image, &header, bytes, file.size(), &error) == TINYEXR_SUCCESS);
  REQUIRE(header.num_channels == 6);
  const char* const names[6] = {"B", "G", "R", "Z", "direct.R", "id"};
  for (int k = 0; k < 6; ++k) {
    CHECK(std::string(header.channels[k].name) == names[k]);
    CHECK(header.pixel_types[k] == (k == 5 ? TINYEXR_PIXELTYPE_UINT : TINYEXR_PIXELTYPE_FLOAT));
  }
  for (size_t k = 0; k < 4; ++k) {
    CHECK(reinterpret_cast<float*>(image.images[0])[k] == 3);
    CHECK(reinterpret_cast<float*>(image.images[3])[k] == picture.channels[1].values[k]);
    CHECK(reinterpret_cast<float*>(image.images[4])[k] == picture.channels[0].values[k]);
    CHECK(reinterpret_cast<uint32_t*>(image.images[5])[k] == picture.channels[2].numbers[k]);
  }
  FreeEXRImage(&image);
  FreeEXRHeader(&header);
}
