// Repeated measurements to their median and spread, as JSON and as words.
#include "tools/bench/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

Json make_figure(std::vector<double> runs, std::string_view unit) {
  std::sort(runs.begin(), runs.end());
  const size_t middle = runs.size() / 2;
  const double median = runs.size() % 2 == 1 ? runs[middle] : 0.5 * (runs[middle - 1] + runs[middle]);
  return {{"unit", unit},
          {"median", median},
          {"low", runs.front()},
          {"high", runs.back()},
          {"runs", runs.size()}};
}

std::string format_si(double value) {
  for (const auto& [scale, letter] : {std::pair{1e9, " G"}, {1e6, " M"}, {1e3, " k"}})
    if (std::abs(value) >= scale) return fmt::format("{:.3g}{}", value / scale, letter);
  return fmt::format("{:.3g} ", value);
}

std::string format_figure(const Json& figure) {
  const double median = figure["median"].get<double>();
  double scale = 1;
  std::string letter;
  for (const auto& [size, name] : {std::pair{1e9, "G"}, {1e6, "M"}, {1e3, "k"}})
    if (std::abs(median) >= size) {
      scale = size, letter = name;
      break;
    }
  const std::string unit = letter + figure["unit"].get<std::string>();
  const std::string text = fmt::format("{:.3g}{}{}", median / scale, unit.empty() ? "" : " ", unit);
  if (figure["runs"] == 1) return text + " (1 run)";
  return text + fmt::format(" ({:.3g} .. {:.3g})", figure["low"].get<double>() / scale,
                            figure["high"].get<double>() / scale);
}

Noise find_noise(const Json& result) {
  Noise noise;
  if (result.is_object() && result.contains("median")) {
    const double median = std::abs(result["median"].get<double>());
    const double spread = result["high"].get<double>() - result["low"].get<double>();
    return {1, spread > kNoisySpread * median ? 1u : 0u};
  }
  if (!result.is_structured()) return noise;
  for (const Json& part : result) {
    const Noise inner = find_noise(part);
    noise.figure_count += inner.figure_count;
    noise.noisy_count += inner.noisy_count;
  }
  return noise;
}

}  // namespace patchlight
