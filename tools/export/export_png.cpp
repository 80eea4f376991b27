// Display-linear pixels -> PNG in memory.
#include "tools/export/exporters.h"
#include "tools/image/image_writer.h"
#include "tools/image/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchlight {
namespace {

// encode_srgb() from a table over the square root, in which the function is nearly straight: within 1e-5.
class SrgbTable {
 public:
  SrgbTable() {
    for (size_t k = 0; k < kSteps + 2; ++k) {
      const float root = static_cast<float>(k) / kSteps;
      value_[k] = encode_srgb(root * root);
    }
  }
  float encode(float linear) const {
    const float at = std::sqrt(linear) * kSteps;
    const auto k = static_cast<size_t>(at);
    return value_[k] + (at - static_cast<float>(k)) * (value_[k + 1] - value_[k]);
  }

 private:
  static constexpr size_t kSteps = 1024;
  std::array<float, kSteps + 2> value_;
};

// Ordered dither (Bayer: An Optimum Method for Two-Level Rendition of Continuous-Tone Pictures, 1973): smooth
// walls would show bands of equal bytes. In (0, 1), so that 0 stays 0 and 1 stays 255.
constexpr std::array<std::array<float, 8>, 8> make_bayer() {
  std::array<std::array<float, 8>, 8> table{};
  for (unsigned y = 0; y < 8; ++y)
    for (unsigned x = 0; x < 8; ++x) {
      unsigned order = 0;
      for (unsigned bit = 0; bit < 3; ++bit) {
        const unsigned a = (x >> bit) & 1u, b = (y >> bit) & 1u;
        order |= (((a ^ b) << 1) | b) << (2 * (2 - bit));
      }
      table[y][x] = (static_cast<float>(order) + 0.5f) / 64;
    }
  return table;
}
constexpr auto kBayer = make_bayer();

}  // namespace

std::string encode_png(const Picture& picture) {
  static const SrgbTable srgb;
  const size_t width = picture.width;
  std::vector<uint8_t> bytes(width * picture.height * 3);
  for (size_t y = 0; y < picture.height; ++y)
    for (size_t x = 0; x < width; ++x)
      for (int k = 0; k < 3; ++k) {
        const float linear = std::clamp(picture.pixels[y * width + x][k], 0.0f, 1.0f);
        const float level = 255 * srgb.encode(linear) + kBayer[y % 8][x % 8];
        bytes[(y * width + x) * 3 + static_cast<size_t>(k)] = static_cast<uint8_t>(level);
      }
  return pack_png(picture.width, picture.height, bytes);
}

}  // namespace patchlight
