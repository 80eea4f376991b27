// Radiosity -> Radiance HDR (Ward: Real Pixels, 1991): 8 bits a channel and a shared exponent, no tone
// mapping.
#include "tools/export/exporters.h"
#include "tools/image/image_writer.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

std::string encode_hdr(const Picture& picture) {
  // Its exponents reach to 1e38; it knows no negative numbers and nothing that is no number.
  constexpr float kMost = 1e38f;
  std::vector<float> values;
  values.reserve(picture.pixels.size() * 3);
  for (const Rgb& pixel : picture.pixels)
    for (int k = 0; k < 3; ++k)
      values.push_back(std::isnan(pixel[k]) ? 0 : std::clamp(pixel[k], 0.0f, kMost));
  return pack_hdr(picture.width, picture.height, values);
}

}  // namespace patchlight
