// Pictures out of pictures: boxes filled, parts placed, sizes changed.
#include "tools/image/picture.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <cassert>

namespace patchlight {

Picture make_picture(uint32_t width, uint32_t height, Rgb color) {
  return {width, height, std::vector<Rgb>(size_t{width} * height, color)};
}

void fill_box(Picture& picture, const Box& box, Rgb color, float opacity) {
  const uint32_t x_end = std::min(picture.width, box.x + box.width);
  const uint32_t y_end = std::min(picture.height, box.y + box.height);
  for (uint32_t y = box.y; y < y_end; ++y)
    for (uint32_t x = box.x; x < x_end; ++x) {
      Rgb& pixel = picture.pixels[size_t{y} * picture.width + x];
      pixel += opacity * (color - pixel);
    }
}

void place_picture(Picture& picture, const Picture& part, uint32_t x, uint32_t y) {
  if (x >= picture.width) return;
  const uint32_t width = std::min(part.width, picture.width - x);
  for (uint32_t row = 0; row < part.height && y + row < picture.height; ++row) {
    const auto from = part.pixels.begin() + static_cast<std::ptrdiff_t>(size_t{row} * part.width);
    std::copy(from, from + width,
              picture.pixels.begin() + static_cast<std::ptrdiff_t>(size_t{y + row} * picture.width + x));
  }
}

Picture shrink_picture(const Picture& picture, uint32_t width, uint32_t height) {
  assert(width > 0 && width <= picture.width && height > 0 && height <= picture.height);
  if (width == picture.width && height == picture.height) return picture;
  Picture small = make_picture(width, height, Rgb(0));
  const float step_x = static_cast<float>(picture.width) / static_cast<float>(width);
  const float step_y = static_cast<float>(picture.height) / static_cast<float>(height);
  // The part of pixel `at` that lies between begin and end.
  const auto cover = [](uint32_t at, float begin, float end) {
    const auto low = static_cast<float>(at);
    return std::max(0.0f, std::min(end, low + 1) - std::max(begin, low));
  };
  for_rows(height, 8, [&](size_t first, size_t last) {
    for (size_t y = first; y < last; ++y) {
      const float top = static_cast<float>(y) * step_y, bottom = top + step_y;
      for (uint32_t x = 0; x < width; ++x) {
        const float left = static_cast<float>(x) * step_x, right = left + step_x;
        Rgb sum(0);
        float area = 0;
        for (auto v = static_cast<uint32_t>(top); v < picture.height && static_cast<float>(v) < bottom; ++v)
          for (auto u = static_cast<uint32_t>(left); u < picture.width && static_cast<float>(u) < right;
               ++u) {
            const float weight = cover(u, left, right) * cover(v, top, bottom);
            sum += weight * picture.pixels[size_t{v} * picture.width + u];
            area += weight;
          }
        small.pixels[y * width + x] = sum / area;
      }
    }
  });
  return small;
}

Rgb mix_seen(Rgb ground, Rgb color, float share) {
  Rgb mixed;
  for (int k = 0; k < 3; ++k) {
    const float below = std::sqrt(std::max(ground[k], 0.0f)), above = std::sqrt(std::max(color[k], 0.0f));
    const float root = below + share * (above - below);
    mixed[k] = root * root;
  }
  return mixed;
}

}  // namespace patchlight
