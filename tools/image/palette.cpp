// 8-bit sRGB -> a palette by median cut, and indices by error diffusion.
#include "tools/image/palette.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace patchlight {
namespace {

constexpr size_t kColorsMax = 256;
constexpr unsigned kBits = 6;  // a channel: colours nearer to each other are counted as one

size_t find_bin(int r, int g, int b) {
  constexpr unsigned kShift = 8 - kBits;
  return static_cast<size_t>(r >> kShift) << 2 * kBits | static_cast<size_t>(g >> kShift) << kBits |
         static_cast<size_t>(b >> kShift);
}

// Colours that fell into one bin.
struct Tally {
  std::array<uint64_t, 3> sum{};
  uint64_t count = 0;
  double mean(int channel) const { return static_cast<double>(sum[channel]) / static_cast<double>(count); }
};

// A range of tallies that become one colour.
struct ColorBox {
  size_t first, last;
  int channel;        // along which it is longest
  double difference;  // sum over its pixels of the squared distance from its mean, along that channel
};

ColorBox make_box(std::span<const Tally> tallies, size_t first, size_t last) {
  ColorBox box{first, last, 0, -1};
  for (int channel = 0; channel < 3; ++channel) {
    double sum = 0, squares = 0, count = 0;
    for (size_t k = first; k < last; ++k) {
      const double mean = tallies[k].mean(channel), weight = static_cast<double>(tallies[k].count);
      sum += weight * mean, squares += weight * mean * mean, count += weight;
    }
    const double difference = squares - sum * sum / count;
    if (difference > box.difference) box.channel = channel, box.difference = difference;
  }
  return box;
}

// Where half of the box's pixels lie on either side; both sides hold a tally at least.
size_t find_median(std::span<Tally> tallies, const ColorBox& box) {
  std::sort(tallies.begin() + static_cast<std::ptrdiff_t>(box.first),
            tallies.begin() + static_cast<std::ptrdiff_t>(box.last),
            [&](const Tally& a, const Tally& b) { return a.mean(box.channel) < b.mean(box.channel); });
  uint64_t all = 0, below = 0;
  for (size_t k = box.first; k < box.last; ++k) all += tallies[k].count;
  for (size_t k = box.first; k < box.last - 1; ++k)
    if ((below += tallies[k].count) * 2 >= all) return k + 1;
  return box.last - 1;
}

std::array<uint8_t, 3> find_mean(std::span<const Tally> tallies) {
  Tally all;
  for (const Tally& tally : tallies) {
    for (int k = 0; k < 3; ++k) all.sum[k] += tally.sum[k];
    all.count += tally.count;
  }
  std::array<uint8_t, 3> color;
  for (int k = 0; k < 3; ++k) color[k] = static_cast<uint8_t>(all.mean(k) + 0.5);
  return color;
}

uint8_t find_nearest(const Palette& palette, int r, int g, int b) {
  size_t nearest = 0;
  int least = std::numeric_limits<int>::max();
  for (size_t k = 0; k < palette.size(); ++k) {
    const int dr = palette[k][0] - r, dg = palette[k][1] - g, db = palette[k][2] - b;
    const int distance = 2 * dr * dr + 4 * dg * dg + db * db;  // as the eye weighs them, roughly
    if (distance < least) least = distance, nearest = k;
  }
  return static_cast<uint8_t>(nearest);
}

}  // namespace

Palette pick_palette(const BytePicture& picture) {
  std::vector<Tally> tallies(size_t{1} << 3 * kBits);
  for (const auto& pixel : picture.pixels) {
    Tally& tally = tallies[find_bin(pixel[0], pixel[1], pixel[2])];
    for (int k = 0; k < 3; ++k) tally.sum[k] += pixel[k];
    ++tally.count;
  }
  std::erase_if(tallies, [](const Tally& tally) { return tally.count == 0; });
  if (tallies.empty()) return {{0, 0, 0}};
  std::vector<ColorBox> boxes = {make_box(tallies, 0, tallies.size())};
  while (boxes.size() < kColorsMax) {
    const auto widest =
        std::max_element(boxes.begin(), boxes.end(),
                         [](const ColorBox& a, const ColorBox& b) { return a.difference < b.difference; });
    // Rounding may leave a trace of difference in a box of one tally.
    if (widest->last - widest->first < 2 || widest->difference <= 0) break;
    const size_t middle = find_median(tallies, *widest), last = widest->last;
    *widest = make_box(tallies, widest->first, middle);
    boxes.push_back(make_box(tallies, middle, last));
  }
  Palette palette;
  for (const ColorBox& box : boxes)
    palette.push_back(find_mean(std::span(tallies).subspan(box.first, box.last - box.first)));
  return palette;
}

std::vector<uint8_t> index_pixels(const BytePicture& picture, const Palette& palette) {
  const auto width = static_cast<std::ptrdiff_t>(picture.width);
  std::vector<uint8_t> indices(picture.pixels.size());
  // The nearest colour of each bin, once it was asked for.
  constexpr int16_t kUnknown = -1;
  std::vector<int16_t> nearest(size_t{1} << 3 * kBits, kUnknown);
  // Sixteenths that this row and the next one still lack, with a pixel more on either side.
  using Lack = std::array<int, 3>;
  std::vector<Lack> here(picture.width + size_t{2}), below(picture.width + size_t{2});
  for (size_t y = 0; y < picture.height; ++y) {
    std::fill(below.begin(), below.end(), Lack{});
    // Every other row runs backwards: lacks would all drift one way.
    const std::ptrdiff_t step = y % 2 == 0 ? 1 : -1;
    for (std::ptrdiff_t k = 0, x = step > 0 ? 0 : width - 1; k < width; ++k, x += step) {
      const size_t pixel = y * picture.width + static_cast<size_t>(x), at = static_cast<size_t>(x) + 1;
      std::array<int, 3> wanted;
      for (int c = 0; c < 3; ++c) wanted[c] = std::clamp(picture.pixels[pixel][c] + here[at][c] / 16, 0, 255);
      int16_t& known = nearest[find_bin(wanted[0], wanted[1], wanted[2])];
      if (known == kUnknown) known = find_nearest(palette, wanted[0], wanted[1], wanted[2]);
      indices[pixel] = static_cast<uint8_t>(known);
      for (int c = 0; c < 3; ++c) {
        const int lack = wanted[c] - palette[static_cast<size_t>(known)][c];
        here[static_cast<size_t>(x + step + 1)][c] += 7 * lack;
        below[static_cast<size_t>(x - step + 1)][c] += 3 * lack;
        below[at][c] += 5 * lack;
        below[static_cast<size_t>(x + step + 1)][c] += lack;
      }
    }
    here.swap(below);
  }
  return indices;
}

}  // namespace patchlight
