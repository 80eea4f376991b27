// Numbers -> colours of a map, and its legend.
#include "false_color.h"

#include "engine/base/parallel.h"
#include "lettering.h"
#include "srgb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace patchlight {
namespace {

constexpr double kLampsBeyond = 10, kShareBelowTop = 0.995, kShareBelowBottom = 0.01;
constexpr double kDecadesMost = 4, kLogRatio = 20;
constexpr uint32_t kLegendWidthMin = 160, kLegendHeightMin = 120;

Rgb decode_color(Rgb c) { return {decode_srgb(c.r), decode_srgb(c.g), decode_srgb(c.b)}; }

Rgb make_color(uint32_t hex) {
  return Rgb(static_cast<float>(hex >> 16), static_cast<float>(hex >> 8 & 0xffu),
             static_cast<float>(hex & 0xffu)) /
         255.0f;
}

// Rounds down (or up) to 1, 2 or 5 times a power of ten.
double round_nice(double value, bool up) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  const double share = value / power;
  constexpr double kSlack = 1e-9;
  constexpr std::array<double, 4> kSteps = {1, 2, 5, 10};
  if (up)
    return power * *std::find_if(kSteps.begin(), kSteps.end() - 1,
                                 [&](double step) { return step >= share * (1 - kSlack); });
  return power * *std::find_if(kSteps.rbegin() + 1, kSteps.rend() - 1,
                               [&](double step) { return step <= share * (1 + kSlack); });
}

// The step of some five ticks on a linear scale.
double find_step(double low, double high) { return round_nice((high - low) / 5, true); }

void round_ends(ColorScale& scale) {
  if (scale.log) {
    scale.low = round_nice(scale.low, false), scale.high = round_nice(scale.high, true);
    if (scale.low >= scale.high) scale.low = scale.high / 10;
    return;
  }
  const double step = find_step(scale.low, scale.high);
  scale.low = std::floor(scale.low / step + 1e-9) * step;
  scale.high = std::ceil(scale.high / step - 1e-9) * step;
}

float find_rank(std::span<float> values, double share) {
  const auto rank =
      std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

template <class Value>
std::vector<Rgb> color_all(const ColorScale& scale, size_t count, const Value& value) {
  std::vector<Rgb> colors(count);
  for_rows(count, 4096, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) colors[k] = find_color(scale, value(k));
  });
  return colors;
}

void draw_classes(Picture& picture, const Box& box, const ColorScale& scale, float size, Rgb color) {
  const auto em = static_cast<uint32_t>(size);
  float x = static_cast<float>(box.x);
  for (size_t k = 0; k < scale.classes.size(); ++k) {
    const Box swatch{static_cast<uint32_t>(x), box.y + em * 3 / 2, em, em};
    const uint32_t line = std::max(em / 12, 1u);
    fill_box(picture, swatch, color);
    fill_box(picture, {swatch.x + line, swatch.y + line, em - 2 * line, em - 2 * line},
             find_color(scale, static_cast<double>(k)));
    x += 1.3f * size;
    draw_text(picture, x, static_cast<float>(box.y) + 2.35f * size, scale.classes[k], {size, color});
    x += measure_text(scale.classes[k], size) + 0.8f * size;
  }
}

}  // namespace

Rgb map_viridis(double t) {
  // Nine of its 256 colours; between them it is straight within 1 %.
  static const auto kStops = [] {
    std::array<Rgb, 9> stops;
    constexpr uint32_t kHex[9] = {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c,
                                  0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};
    for (size_t k = 0; k < 9; ++k) stops[k] = make_color(kHex[k]);
    return stops;
  }();
  const double at = std::clamp(t, 0.0, 1.0) * 8;
  const size_t k = std::min(static_cast<size_t>(at), size_t{7});
  const auto share = static_cast<float>(at - static_cast<double>(k));
  return decode_color(kStops[k] + share * (kStops[k + 1] - kStops[k]));
}

double find_position(const ColorScale& scale, double value) {
  if (!scale.classes.empty())
    return scale.classes.size() < 2 ? 0 : value / static_cast<double>(scale.classes.size() - 1);
  if (!scale.log) return std::clamp((value - scale.low) / (scale.high - scale.low), 0.0, 1.0);
  if (value <= scale.low) return 0;
  return std::min(std::log(value / scale.low) / std::log(scale.high / scale.low), 1.0);
}

Rgb find_color(const ColorScale& scale, double value) {
  return std::isnan(value) ? Rgb(1, 0, 1) : map_viridis(find_position(scale, value));
}

ColorScale pick_radiosity_scale(std::span<float> values, double brightest, ScaleKind kind) {
  ColorScale scale{.title = "radiosity, W/m\xc2\xb2", .log = kind == ScaleKind::kLog};
  const auto lit = std::partition(values.begin(), values.end(), [](float value) { return value > 0; });
  const std::span<float> bright(values.begin(), lit);
  if (bright.empty()) {
    scale.low = scale.log ? 0.1 : 0;
    return scale;
  }
  const double below = double{find_rank(bright, kShareBelowTop)};
  scale.high = brightest <= kLampsBeyond * below ? std::max(brightest, below) : below;
  scale.low =
      std::max(double{find_rank(bright, kShareBelowBottom)}, scale.high * std::pow(10, -kDecadesMost));
  if (kind == ScaleKind::kAuto) scale.log = scale.high > kLogRatio * scale.low;
  // A linear scale starts at 0 unless all that there is lies far from it.
  if (!scale.log && scale.low < scale.high / 2) scale.low = 0;
  if (scale.low >= scale.high) scale.low = scale.high / 2;
  round_ends(scale);
  return scale;
}

ColorScale make_residual_scale(const ColorScale& radiosity, ScaleKind kind) {
  ColorScale scale = radiosity;
  scale.title = "added, W/m\xc2\xb2";
  scale.log = kind != ScaleKind::kLinear;
  scale.low = scale.log ? scale.high * std::pow(10, -kDecadesMost) : 0;
  round_ends(scale);
  return scale;
}

ColorScale make_level_scale(const PatchTable& elements) {
  ColorScale scale{.title = "times that a patch's polygon was halved"};
  const uint8_t most =
      elements.size() == 0 ? 0 : *std::max_element(elements.level.begin(), elements.level.end());
  for (uint32_t level = 0; level <= most; ++level) scale.classes.push_back(fmt::format("{}", level));
  return scale;
}

ColorScale make_reason_scale() {
  return {.title = "why patches were split",
          .classes = {"start", "direct light", "indirect light", "balance"}};
}

std::vector<Rgb> color_values(const ColorScale& scale, std::span<const Rgb> values) {
  return color_all(scale, values.size(), [&](size_t k) { return double{luminance(values[k])}; });
}

std::vector<Rgb> color_levels(const ColorScale& scale, const PatchTable& elements) {
  return color_all(scale, elements.size(), [&](size_t k) { return double(elements.level[k]); });
}

std::vector<Rgb> color_reasons(const ColorScale& scale, std::span<const SplitReason> reasons) {
  return color_all(scale, reasons.size(), [&](size_t k) { return static_cast<double>(reasons[k]); });
}

std::vector<double> find_ticks(const ColorScale& scale) {
  std::vector<double> ticks;
  if (!scale.log) {
    const double step = find_step(scale.low, scale.high);
    for (int k = 0; scale.low + k * step <= scale.high + 1e-6 * step; ++k)
      ticks.push_back(scale.low + k * step);
    return ticks;
  }
  const bool few = scale.high / scale.low < 1001;
  for (double power = std::pow(10, std::floor(std::log10(scale.low) + 1e-9));
       power <= scale.high * (1 + 1e-9); power *= 10)
    for (const double share : {1.0, 2.0, 5.0})
      if ((share == 1 || few) && share * power >= scale.low * (1 - 1e-9) &&
          share * power <= scale.high * (1 + 1e-9))
        ticks.push_back(share * power);
  return ticks;
}

std::string format_tick(double value) {
  if (std::abs(value) < 1e-12) return "0";
  std::string text = std::abs(value) >= 1e5 || std::abs(value) < 1e-3 ? fmt::format("{:.0e}", value)
                                                                      : fmt::format("{:.4g}", value);
  // 2e-05, 1e+06: 2e-5, 1e6.
  if (const size_t e = text.find('e'); e != std::string::npos) {
    const int power = std::stoi(text.substr(e + 1));
    text = fmt::format("{}e{}", text.substr(0, e), power);
  }
  return text;
}

void draw_scale(Picture& picture, const Box& box, const ColorScale& scale, float letter_size,
                Rgb letter_color) {
  const auto em = static_cast<uint32_t>(letter_size);
  draw_text(picture, static_cast<float>(box.x), static_cast<float>(box.y) + 0.95f * letter_size, scale.title,
            {letter_size, letter_color});
  if (!scale.classes.empty()) return draw_classes(picture, box, scale, letter_size, letter_color);
  const uint32_t top = box.y + em * 3 / 2;
  for (uint32_t x = 0; x < box.width; ++x)
    fill_box(picture, {box.x + x, top, 1, em}, map_viridis((x + 0.5) / box.width));
  float free_from = -std::numeric_limits<float>::max();
  for (const double tick : find_ticks(scale)) {
    const float x = static_cast<float>(box.x + find_position(scale, tick) * (box.width - 1));
    const std::string text = format_tick(tick);
    const float half = measure_text(text, letter_size) / 2;
    fill_box(picture, {static_cast<uint32_t>(x), top + em, std::max(em / 12, 1u), em / 3}, letter_color);
    // Numbers that would run into each other are left out.
    if (x - half < free_from) continue;
    draw_text(picture, x, static_cast<float>(top) + 2.35f * letter_size, text,
              {letter_size, letter_color, TextAlign::kCentre});
    free_from = x + half + 0.4f * letter_size;
  }
}

void draw_legend(Picture& picture, const ColorScale& scale) {
  if (picture.width < kLegendWidthMin || picture.height < kLegendHeightMin) return;
  const float size = std::clamp(static_cast<float>(picture.height) / 36, 10.0f, 40.0f);
  const auto em = static_cast<uint32_t>(size);
  float width = 28 * size;
  if (!scale.classes.empty()) {
    width = 0;
    for (const std::string& name : scale.classes) width += measure_text(name, size) + 2.1f * size;
  }
  width = std::max(width, measure_text(scale.title, size)) + 3 * size;
  const uint32_t panel_width = std::min(picture.width - em, static_cast<uint32_t>(width));
  // Names stand beside their colours, numbers below.
  const uint32_t panel_height = scale.classes.empty() ? em * 5 : em * 4;
  const Box panel{em / 2, picture.height - em / 2 - panel_height, panel_width, panel_height};
  fill_box(picture, panel, Rgb(0.01f), 0.92f);
  draw_scale(picture, {panel.x + em * 3 / 2, panel.y + em / 2, panel.width - 3 * em, em * 4}, scale, size,
             Rgb(0.9f));
}

}  // namespace patchlight
