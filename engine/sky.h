// What shines from infinitely far away: the sky, the ground below its horizon, and a sun, by direction. y is
// up. Emission is radiance times pi, W/m2, as everywhere: a plane under a whole sky of emission E receives E.
#pragma once

#include "engine/base/vector.h"

#include <array>
#include <optional>

namespace patchlight {

// How a clear sky's luminance (Y) and chromaticity (x, y of CIE 1931) go with the direction (Preetham,
// Shirley, Smits: A Practical Analytic Model for Daylight, 1999).
struct ClearSky {
  std::array<std::array<double, 5>, 3> perez{};  // A to E of Perez's function, for Y, x, y
  DVec3 zenith{0};                               // Y (kcd/m2), x, y there
  DVec3 perez_zenith{1};                         // Perez's function there
  DVec3 sun{0, 1, 0};                            // unit, towards the sun
  DRgb scale{0};                                 // emission, W/m2, of a kcd/m2 of white
};

struct Sky {
  // Above the horizon it goes from `horizon` to `zenith` with the sine of the elevation, or as `clear` says.
  Rgb zenith{0}, horizon{0}, ground{0};  // W/m2
  std::optional<ClearSky> clear;
  // The sun: a disc that shines on its own, on top of the sky.
  Vec3 sun_direction{0, 1, 0};  // unit, towards the sun
  float sun_radius = 0;         // half its angle, radians
  Rgb sun_emission{0};          // W/m2; seen straight on it brings this times the squared sine of its radius

  bool is_lit() const { return clear || largest(max(zenith, horizon)) > 0; }  // above the horizon
  bool has_ground() const { return largest(ground) > 0; }
  bool has_sun() const { return largest(sun_emission) > 0; }
  bool is_dark() const { return !is_lit() && !has_ground() && !has_sun(); }
};

// Throws std::invalid_argument where it is not what the lines above say.
void check_sky(const Sky& sky);

// The same all over.
Sky make_uniform_sky(Rgb emission);
// The standard overcast sky, three times as bright at the zenith as at the horizon: L = Lz (1 + 2 sin e) / 3,
// e the elevation (CIE S 011 / ISO 15469, type 16). irradiance: on an unblocked horizontal plane, W/m2.
Sky make_overcast_sky(Rgb irradiance);
// A clear sky. turbidity: 2 (very clear) to 10 (hazy). sun: unit, towards the sun, not below the horizon.
// irradiance, W/m2: its luminance is that of what an unblocked horizontal plane receives; the sky's colours
// are multiplied by it.
Sky make_clear_sky(double turbidity, DVec3 sun, Rgb irradiance);
// The model in its own units, for the sun at `angle` from the zenith, radians: Y in kcd/m2, x, y.
ClearSky find_clear_sky(double turbidity, DVec3 sun);

// Emission in a direction (unit), without the sun, W/m2.
Rgb find_sky_emission(const Sky& sky, Vec3 direction);
// Does the disc of the sun cover it?
inline bool is_in_sun(const Sky& sky, Vec3 direction) {
  const Vec3 apart = direction - sky.sun_direction;
  const float chord = 2 * std::sin(sky.sun_radius / 2);
  return dot(apart, apart) < chord * chord;
}

}  // namespace patchlight
