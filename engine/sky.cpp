// Directions to emission.
#include "engine/sky.h"

#include <stdexcept>
#include <string>

namespace patchlight {
namespace {

// Tables 2 to 4 of the paper: each coefficient is the first number times the turbidity, plus the second.
constexpr double kPerez[3][5][2] = {
    {{0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}},
    {{-0.0193, -0.2592}, {-0.0665, 0.0008}, {-0.0004, 0.2125}, {-0.0641, -0.8989}, {-0.0033, 0.0452}},
    {{-0.0167, -0.2608}, {-0.0950, 0.0092}, {-0.0079, 0.2102}, {-0.0441, -1.6537}, {-0.0109, 0.0529}}};
// Chromaticity of the zenith: rows go with the turbidity's square, itself and 1, columns with powers of the
// sun's angle, 3 to 0.
constexpr double kZenith[2][3][4] = {{{0.00166, -0.00375, 0.00209, 0},
                                      {-0.02903, 0.06377, -0.03202, 0.00394},
                                      {0.11693, -0.21196, 0.06052, 0.25886}},
                                     {{0.00275, -0.00610, 0.00317, 0},
                                      {-0.04214, 0.08970, -0.04153, 0.00516},
                                      {0.15346, -0.26756, 0.06670, 0.26688}}};
constexpr double kCosineMin = 1e-4;  // of the angle to the zenith: the horizon itself has no value

// cosine: of the angle to the zenith; gamma: the angle to the sun.
double find_perez(const std::array<double, 5>& p, double cosine, double gamma, double cosine_gamma) {
  return (1 + p[0] * std::exp(p[1] / std::max(cosine, kCosineMin))) *
         (1 + p[2] * std::exp(p[3] * gamma) + p[4] * cosine_gamma * cosine_gamma);
}

// Linear sRGB (ITU-R BT.709 primaries, white D65) from Y and the chromaticity; colours beyond it are cut off.
DRgb find_rgb(double luminance, double x, double y) {
  const double X = x / y * luminance, Z = (1 - x - y) / y * luminance;
  return max(DRgb(3.2404542 * X - 1.5371385 * luminance - 0.4985314 * Z,
                  -0.9692660 * X + 1.8760108 * luminance + 0.0415560 * Z,
                  0.0556434 * X - 0.2040259 * luminance + 1.0572252 * Z),
             DRgb(0));
}

DRgb find_clear_emission(const ClearSky& clear, DVec3 direction) {
  const double cosine_gamma = std::clamp(dot(direction, clear.sun), -1.0, 1.0);
  const double gamma = std::acos(cosine_gamma);
  DVec3 value;
  for (int k = 0; k < 3; ++k)
    value[k] = clear.zenith[k] / clear.perez_zenith[k] *
               find_perez(clear.perez[static_cast<size_t>(k)], direction.y, gamma, cosine_gamma);
  return clear.scale * find_rgb(std::max(value.x, 0.0), value.y, value.z);
}

void require(bool right, const char* what) {
  if (!right) throw std::invalid_argument(std::string("sky: ") + what);
}

bool is_light(Rgb value) {
  for (int k = 0; k < 3; ++k)
    if (!(value[k] >= 0 && std::isfinite(value[k]))) return false;
  return true;
}

}  // namespace

void check_sky(const Sky& sky) {
  constexpr float kLengthSlack = 1e-3f;
  require(is_light(sky.zenith) && is_light(sky.horizon) && is_light(sky.ground) && is_light(sky.sun_emission),
          "emission: finite, at least 0");
  require(std::abs(length(sky.sun_direction) - 1) <= kLengthSlack, "sun_direction: of length 1");
  require(sky.sun_radius >= 0 && sky.sun_radius < kPi / 2, "sun_radius: from 0 to below a right angle");
  require(!sky.has_sun() || sky.sun_radius > 0, "sun_radius: above 0 where the sun shines");
}

Sky make_uniform_sky(Rgb emission) {
  Sky sky;
  sky.zenith = sky.horizon = emission;
  return sky;
}

Sky make_overcast_sky(Rgb irradiance) {
  // The horizontal plane receives a third of the horizon's emission and two thirds of the zenith's.
  Sky sky;
  sky.zenith = 9 / 7.0f * irradiance;
  sky.horizon = sky.zenith / 3.0f;
  return sky;
}

ClearSky find_clear_sky(double turbidity, DVec3 sun) {
  ClearSky clear;
  clear.sun = sun;
  for (size_t k = 0; k < 3; ++k)
    for (size_t c = 0; c < 5; ++c) clear.perez[k][c] = kPerez[k][c][0] * turbidity + kPerez[k][c][1];
  const double angle = std::acos(std::clamp(sun.y, -1.0, 1.0));
  const double chi = (4 / 9.0 - turbidity / 120) * (std::numbers::pi - 2 * angle);
  clear.zenith.x = (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
  const double powers[4] = {angle * angle * angle, angle * angle, angle, 1};
  const double rows[3] = {turbidity * turbidity, turbidity, 1};
  for (int k = 0; k < 2; ++k) {
    double sum = 0;
    for (size_t row = 0; row < 3; ++row)
      for (size_t column = 0; column < 4; ++column)
        sum += rows[row] * kZenith[k][row][column] * powers[column];
    clear.zenith[k + 1] = sum;
  }
  for (int k = 0; k < 3; ++k)
    clear.perez_zenith[k] = find_perez(clear.perez[static_cast<size_t>(k)], 1, angle, sun.y);
  clear.scale = DRgb(1);
  return clear;
}

Sky make_clear_sky(double turbidity, DVec3 sun, Rgb irradiance) {
  ClearSky clear = find_clear_sky(turbidity, sun);
  // What a horizontal plane receives: the mean over the disc below the sky, for sine squared and azimuth are
  // even there.
  constexpr int kRings = 128, kParts = 256;
  double received = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double sine_squared = (ring + 0.5) / kRings, cosine = std::sqrt(1 - sine_squared);
    for (int part = 0; part < kParts; ++part) {
      const double azimuth = 2 * std::numbers::pi * (part + 0.5) / kParts, sine = std::sqrt(sine_squared);
      const DRgb value =
          find_clear_emission(clear, {sine * std::cos(azimuth), cosine, sine * std::sin(azimuth)});
      received += double{luminance(Rgb(value))};
    }
  }
  clear.scale = DRgb(irradiance) * (kRings * kParts / received);
  Sky sky;
  sky.clear = clear;
  return sky;
}

Rgb find_sky_emission(const Sky& sky, Vec3 direction) {
  if (direction.y < 0) return sky.ground;
  if (sky.clear) return Rgb(find_clear_emission(*sky.clear, DVec3(direction)));
  return sky.horizon + std::min(direction.y, 1.0f) * (sky.zenith - sky.horizon);
}

}  // namespace patchlight
