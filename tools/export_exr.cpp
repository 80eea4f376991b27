// Radiosity -> OpenEXR in memory, by tinyexr: three float32 channels, ZIP, no tone mapping.
#include "exporters.h"

#include <tinyexr.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace patchlight {

std::string encode_exr(const Picture& picture) {
  // The format wants the channels apart and in alphabetical order.
  std::array<std::vector<float>, 3> channels;
  constexpr const char* kNames[3] = {"B", "G", "R"};
  std::array<float*, 3> columns;
  for (int k = 0; k < 3; ++k) {
    channels[k].reserve(picture.pixels.size());
    for (const Rgb& pixel : picture.pixels) channels[k].push_back(pixel[2 - k]);
    columns[k] = channels[k].data();
  }

  EXRImage image;
  InitEXRImage(&image);
  image.num_channels = 3;
  image.images = reinterpret_cast<unsigned char**>(columns.data());
  image.width = static_cast<int>(picture.width);
  image.height = static_cast<int>(picture.height);

  std::array<EXRChannelInfo, 3> infos{};
  std::array<int, 3> types;
  types.fill(TINYEXR_PIXELTYPE_FLOAT);
  for (int k = 0; k < 3; ++k) std::strcpy(infos[k].name, kNames[k]);
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = 3;
  header.channels = infos.data();
  header.pixel_types = types.data();
  header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;

  unsigned char* memory = nullptr;
  const char* error = nullptr;
  const size_t size = SaveEXRImageToMemory(&image, &header, &memory, &error);
  if (size == 0) {
    const std::string words = error != nullptr ? error : "no reason given";
    FreeEXRErrorMessage(error);
    throw std::runtime_error("tinyexr: " + words);
  }
  std::string file(reinterpret_cast<const char*>(memory), size);
  std::free(memory);
  return file;
}

}  // namespace patchlight
