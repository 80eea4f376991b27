// The transfer function of sRGB (IEC 61966-2-1): linear light 0..1 to what files hold, and back.
#pragma once

#include "engine/base/vector.h"

#include <cmath>

namespace patchlight {

inline float encode_srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

inline float decode_srgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

}  // namespace patchlight
