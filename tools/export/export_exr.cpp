// Radiosity and what else is known of each pixel -> OpenEXR in memory, by tinyexr: 32-bit channels, ZIP, no
// tone mapping.
#include "tools/export/exporters.h"

#include <tinyexr.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace patchlight {
namespace {

// What tinyexr wants of a channel: its values in a column of their own.
struct Column {
  std::string name;
  const unsigned char* values;
  int type;
};

// R, G and B out of the pixels; they stay in `floats`, which must not grow afterwards.
void add_colors(std::vector<Column>& columns, std::vector<std::vector<float>>& floats,
                std::span<const Rgb> pixels) {
  constexpr const char* kNames[3] = {"R", "G", "B"};
  for (int k = 0; k < 3; ++k) {
    std::vector<float>& values = floats.emplace_back();
    values.reserve(pixels.size());
    for (const Rgb& pixel : pixels) values.push_back(pixel[k]);
    columns.push_back(
        {kNames[k], reinterpret_cast<const unsigned char*>(values.data()), TINYEXR_PIXELTYPE_FLOAT});
  }
}

}  // namespace

std::string encode_exr(const Picture& picture) {
  std::vector<Column> columns;
  std::vector<std::vector<float>> floats;
  floats.reserve(3);
  add_colors(columns, floats, picture.pixels);
  for (const Channel& channel : picture.channels)
    if (channel.numbers.empty())
      columns.push_back({channel.name, reinterpret_cast<const unsigned char*>(channel.values.data()),
                         TINYEXR_PIXELTYPE_FLOAT});
    else
      columns.push_back({channel.name, reinterpret_cast<const unsigned char*>(channel.numbers.data()),
                         TINYEXR_PIXELTYPE_UINT});
  // The format wants them in alphabetical order.
  std::sort(columns.begin(), columns.end(), [](const Column& a, const Column& b) { return a.name < b.name; });

  std::vector<EXRChannelInfo> infos(columns.size());
  std::vector<int> types;
  std::vector<unsigned char*> images;
  for (size_t k = 0; k < columns.size(); ++k) {
    infos[k] = {};
    std::strncpy(infos[k].name, columns[k].name.c_str(), sizeof infos[k].name - 1);
    types.push_back(columns[k].type);
    images.push_back(const_cast<unsigned char*>(columns[k].values));  // It only reads them.
  }
  EXRImage image;
  InitEXRImage(&image);
  image.num_channels = static_cast<int>(columns.size());
  image.images = images.data();
  image.width = static_cast<int>(picture.width);
  image.height = static_cast<int>(picture.height);
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = image.num_channels;
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
