// Display-linear pictures -> frames of an animation.
#include "tools/image/animation.h"

#include "engine/base/parallel.h"
#include "tools/image/lettering.h"
#include "tools/image/srgb.h"

#include <algorithm>

namespace patchlight {
namespace {

constexpr uint32_t kWidthMax = 960;

struct FrameSize {
  uint32_t width, height;
};
FrameSize find_frame_size(uint32_t width, uint32_t height) {
  const uint32_t smaller = std::min(width, kWidthMax);
  return {smaller,
          static_cast<uint32_t>(std::max<uint64_t>(uint64_t{height} * smaller / std::max(width, 1u), 1))};
}

}  // namespace

void add_frame(Animation& animation, const Picture& picture, const std::string& label, double seconds) {
  const auto [width, height] = find_frame_size(picture.width, picture.height);
  Picture frame = shrink_picture(picture, width, height);
  draw_label(frame, label);
  BytePicture bytes{width, height, {}};
  bytes.pixels.resize(frame.pixels.size());
  for_rows(frame.pixels.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k)
      for (int c = 0; c < 3; ++c) {
        const float linear = std::clamp(frame.pixels[k][c], 0.0f, 1.0f);
        bytes.pixels[k][static_cast<size_t>(c)] = static_cast<uint8_t>(255 * encode_srgb(linear) + 0.5f);
      }
  });
  animation.frames.push_back(std::move(bytes));
  animation.seconds.push_back(seconds);
}

uint64_t count_frame_bytes(uint32_t picture_width, uint32_t picture_height) {
  const auto [width, height] = find_frame_size(picture_width, picture_height);
  return uint64_t{width} * height * 3;
}

}  // namespace patchlight
