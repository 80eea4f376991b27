// The table of curves.
#include "tools/image/tone.h"

#include <algorithm>

namespace patchlight {
namespace {

// A film's curve: contrast in the middle, a toe and a shoulder (Narkowicz: ACES Filmic Tone Mapping Curve,
// 2015, a fit to the curve of the Academy Color Encoding System).
double bend_filmic(double exposed) {
  // Beyond it the curve is 1; below 0 it has a pole.
  const double x = std::clamp(exposed, 0.0, 1e6);
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

constexpr Tone kTones[] = {
    {"filmic", "soft highlights", bend_filmic},
};

}  // namespace

std::span<const Tone> tones() { return kTones; }

const Tone* find_tone(std::string_view name) {
  for (const Tone& tone : kTones)
    if (tone.name == name) return &tone;
  return nullptr;
}

std::vector<std::string> tone_names() {
  std::vector<std::string> names = {"clip"};
  for (const Tone& tone : kTones) names.emplace_back(tone.name);
  return names;
}

}  // namespace patchlight
