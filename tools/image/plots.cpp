// Reports of passes and rounds -> SVG, written as text: it has few enough parts.
#include "tools/image/plots.h"

#include "tools/base/format.h"
#include "tools/image/color_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kWidth = 760, kHeight = 440;
constexpr double kLeft = 86, kRight = 24, kTop = 58, kBottom = 58;
constexpr size_t kPointsMax = 400;
constexpr double kDecadesMost = 8;

// Where the plotted area lies, and what its edges mean.
struct Axes {
  double x_low, x_high, y_low, y_high;
  double x(double value) const {
    return kLeft + (value - x_low) / (x_high - x_low) * (kWidth - kLeft - kRight);
  }
  double y(double value) const {
    return kHeight - kBottom - (value - y_low) / (y_high - y_low) * (kHeight - kTop - kBottom);
  }
};

std::string escape_xml(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else
      safe += c;
  }
  return safe;
}

std::string make_text(double x, double y, std::string_view anchor, std::string_view words, int size = 15,
                      std::string_view more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\"{}>{}</text>\n", x,
                     y, anchor, size, more, escape_xml(words));
}

std::string make_line(double x1, double y1, double x2, double y2, std::string_view style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2,
                     style);
}

constexpr const char* kGrid = "stroke=\"#d8d8d8\"";
constexpr const char* kAxis = "stroke=\"#404040\" stroke-width=\"1.5\"";

std::string open_plot(const PlotText& text, std::string_view what) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
             "font-family=\"'DejaVu Sans', Verdana, Arial, sans-serif\" fill=\"#202020\">\n"
             "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
             kWidth, kHeight) +
         make_text(kLeft, 34, "start", text.title + ": " + std::string(what), 19);
}

std::string close_plot(const Axes& axes, std::string_view x_title) {
  const double bottom = kHeight - kBottom;
  return make_line(kLeft, bottom, kWidth - kRight, bottom, kAxis) +
         make_line(kLeft, kTop, kLeft, bottom, kAxis) +
         make_text((axes.x(axes.x_low) + axes.x(axes.x_high)) / 2, kHeight - 14, "middle", x_title) +
         "</svg>\n";
}

// Whole numbers below the axis, some ten of them.
std::string make_x_numbers(const Axes& axes, uint32_t first, uint32_t last) {
  std::string svg;
  uint32_t step = 1;
  for (uint32_t k = 0; (last - first) / step > 12; ++k) step = k % 3 == 1 ? step / 2 * 5 : step * 2;
  for (uint32_t value = first == 1 && step > 1 ? step : first; value <= last; value += step)
    svg += make_text(axes.x(value), kHeight - kBottom + 21, "middle", fmt::format("{}", value));
  return svg;
}

double find_watts(const DRgb& power, double metres) {
  return double{luminance(Rgb(power))} * metres * metres;
}

// A line through the points that are above 0; each with a dot where they are few.
std::string make_curve(const Axes& axes, std::span<const double> values, std::string_view color,
                       bool dashed) {
  std::string points, dots;
  const size_t count = values.size(), stride = std::max<size_t>(count / kPointsMax, 1);
  std::vector<size_t> picked;
  for (size_t k = 0; k < count; k += stride) picked.push_back(k);
  if (!picked.empty() && picked.back() != count - 1) picked.push_back(count - 1);
  for (const size_t k : picked) {
    if (values[k] <= 0) continue;
    const double y = std::max(std::log10(values[k]), axes.y_low);
    points += fmt::format("{:.1f},{:.1f} ", axes.x(static_cast<double>(k + 1)), axes.y(y));
    if (count <= 40)
      dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n",
                          axes.x(static_cast<double>(k + 1)), axes.y(y), color);
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.5\"{}/>\n", points,
                     color, dashed ? " stroke-dasharray=\"7 5\"" : "") +
         dots;
}

}  // namespace

std::string plot_convergence(std::span<const PassReport> steps, const PlotText& text) {
  std::vector<double> added, unshot;
  for (const PassReport& step : steps) {
    added.push_back(find_watts(step.added_power, text.metres_per_length));
    unshot.push_back(find_watts(step.unshot_power, text.metres_per_length));
  }
  // Where all that a pass adds is what the next one sends, one curve says it.
  const bool two =
      added != unshot && std::any_of(unshot.begin(), unshot.end(), [](double w) { return w > 0; });
  double most = 0, least = 0;
  for (const std::vector<double>* values : {&added, &unshot})
    for (const double watts : *values) {
      if (watts <= 0 || (values == &unshot && !two)) continue;
      most = std::max(most, watts);
      least = least == 0 ? watts : std::min(least, watts);
    }
  if (most == 0) most = 1, least = 0.1;
  Axes axes{1, static_cast<double>(std::max<size_t>(steps.size(), 2)), std::floor(std::log10(least)),
            std::ceil(std::log10(most))};
  if (axes.y_high <= axes.y_low) axes.y_high = axes.y_low + 1;
  axes.y_low = std::max(axes.y_low, axes.y_high - kDecadesMost);
  std::string svg = open_plot(text, fmt::format("power that each {} added", text.step));
  for (double decade = axes.y_low; decade <= axes.y_high; ++decade) {
    svg += make_line(kLeft, axes.y(decade), kWidth - kRight, axes.y(decade), kGrid);
    svg += make_text(kLeft - 9, axes.y(decade) + 5, "end", format_watts(std::pow(10, decade)));
  }
  svg += make_x_numbers(axes, 1, static_cast<uint32_t>(axes.x_high));
  if (two) {
    svg += make_curve(axes, unshot, "#d95f02", true);
    svg += make_text(kWidth - kRight - 6, kTop + 42, "end", "not sent on yet", 15, " fill=\"#d95f02\"");
  }
  svg += make_curve(axes, added, "#21618c", false);
  svg += make_text(kWidth - kRight - 6, kTop + 20, "end", fmt::format("added by the {}", text.step), 15,
                   " fill=\"#21618c\"");
  const double end = text.until > 0 && !added.empty() ? std::log10(text.until * added[0]) : -400;
  if (!two && end > axes.y_low && end < axes.y_high) {
    svg += make_line(kLeft, axes.y(end), kWidth - kRight, axes.y(end),
                     "stroke=\"#7d3c98\" stroke-dasharray=\"3 4\" stroke-width=\"1.5\"");
    svg +=
        make_text(kLeft + 8, axes.y(end) - 7, "start",
                  fmt::format("until: {:g} % of {} 1", 100 * text.until, text.step), 14, " fill=\"#7d3c98\"");
  }
  return svg + close_plot(axes, text.step);
}

std::string plot_rounds(std::span<const RoundReport> rounds, const PlotText& text) {
  double most = 1;
  for (const RoundReport& round : rounds) most = std::max(most, static_cast<double>(round.patch_count));
  const ColorScale scale{.low = 0, .high = most};
  const std::vector<double> ticks = find_ticks(scale);
  const Axes axes{0.5, static_cast<double>(std::max<size_t>(rounds.size(), 1)) + 0.5, 0, 1.12 * most};
  std::string svg = open_plot(text, "patches after each round of refinement");
  for (const double tick : ticks) {
    svg += make_line(kLeft, axes.y(tick), kWidth - kRight, axes.y(tick), kGrid);
    svg += make_text(kLeft - 9, axes.y(tick) + 5, "end", fmt::format("{:.0f}", tick));
  }
  for (size_t k = 0; k < rounds.size(); ++k) {
    const double middle = static_cast<double>(k + 1), count = static_cast<double>(rounds[k].patch_count);
    const double left = axes.x(middle - 0.32), width = axes.x(middle + 0.32) - left;
    svg +=
        fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#21618c\"/>\n",
                    left, axes.y(count), width, axes.y(0) - axes.y(count));
    if (rounds.size() <= 12)
      svg += make_text(axes.x(middle), axes.y(count) - 6, "middle", fmt::format("{}", rounds[k].patch_count),
                       13);
  }
  svg += make_x_numbers(axes, 1, static_cast<uint32_t>(std::max<size_t>(rounds.size(), 1)));
  return svg + close_plot(axes, "round");
}

}  // namespace patchlight
