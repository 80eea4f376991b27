// Pixels -> PNG and Radiance HDR in memory, by stb_image_write. Its own file functions report success on a
// full disk, so it never sees a file.
#include "tools/image/image_writer.h"

#include <new>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

namespace patchlight {
namespace {

void take_bytes(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

}  // namespace

// The sizes are int: the limits on images keep them far below 2^31.
std::string pack_png(uint32_t width, uint32_t height, std::span<const uint8_t> bytes) {
  // Dithered gradients: of all filters "left neighbour" packs best, and the short search loses 5 % of size
  // and halves the time.
  stbi_write_force_png_filter = 1;
  stbi_write_png_compression_level = 5;
  std::string file;
  if (stbi_write_png_to_func(take_bytes, &file, static_cast<int>(width), static_cast<int>(height), 3,
                             bytes.data(), static_cast<int>(width * 3)) == 0)
    throw std::bad_alloc();
  return file;
}

std::string pack_hdr(uint32_t width, uint32_t height, std::span<const float> values) {
  std::string file;
  if (stbi_write_hdr_to_func(take_bytes, &file, static_cast<int>(width), static_cast<int>(height), 3,
                             values.data()) == 0)
    throw std::bad_alloc();
  return file;
}

}  // namespace patchlight
