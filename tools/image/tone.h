// Curves from exposed light to what a display shows: one row a curve.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

struct Tone {
  std::string_view name;
  std::string_view help;
  double (*bend)(double exposed);  // 1 is white; what it gives beyond 0..1 is clipped
};

// Those beside the usual one, which has no row: light is clipped at white.
std::span<const Tone> tones();
// None for clip.
const Tone* find_tone(std::string_view name);
// Their names on the command line, clip first.
std::vector<std::string> tone_names();

}  // namespace patchlight
