// Radiosity -> PFM (Debevec's portable float map): a header of three lines, then rows from the bottom to the
// top, three little-endian floats a pixel, exact.
#include "tools/base/bytes.h"
#include "tools/export/exporters.h"

#include <fmt/format.h>

namespace patchlight {

std::string encode_pfm(const Picture& picture) {
  // A negative scale says that numbers are little-endian.
  std::string file = fmt::format("PF\n{} {}\n-1.0\n", picture.width, picture.height);
  const std::span<const Rgb> pixels = picture.pixels;
  for (size_t row = picture.height; row-- > 0;)
    file += view_bytes(pixels.subspan(row * picture.width, picture.width));
  return file;
}

}  // namespace patchlight
