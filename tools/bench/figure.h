// What was measured several times: {"unit", "median", "low", "high", "runs"}, low and high the extremes.
#pragma once

#include "tools/base/json.h"

#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

constexpr double kNoisySpread = 0.1;  // (high - low) / median beyond which a machine is called noisy

Json make_figure(std::vector<double> runs, std::string_view unit);

// 31.2 M rays/s (30.9 .. 31.5)
std::string format_figure(const Json& figure);
// Three digits, and k, M or G.
std::string format_si(double value);

// How many figures there are anywhere in the result, and how many of them spread beyond kNoisySpread.
struct Noise {
  size_t figure_count = 0, noisy_count = 0;
};
Noise find_noise(const Json& result);

}  // namespace patchlight
