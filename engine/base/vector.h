// The one door to GLM: the vector types of the engine and the few operations that it uses.
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace patchlight {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using DVec2 = glm::dvec2;
using DVec3 = glm::dvec3;
using Rgb = glm::vec3;    // linear red, green, blue
using DRgb = glm::dvec3;  // the same where many are added up

constexpr float kPi = std::numbers::pi_v<float>;
constexpr uint32_t kNone = ~uint32_t{0};

inline float largest(Rgb c) { return std::max(c.r, std::max(c.g, c.b)); }
// Relative luminance of linear sRGB primaries (ITU-R BT.709).
inline float luminance(Rgb c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }
inline float mean_channel(Rgb c) { return (c.r + c.g + c.b) * (1 / 3.0f); }
inline double sum_channels(const DRgb& c) { return c.r + c.g + c.b; }

}  // namespace patchlight
