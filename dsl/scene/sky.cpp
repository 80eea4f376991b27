// Sky and sun: maps to what shines from each direction.
#include "dsl/scene/sky.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

// Rows as the choices of `kind`.
enum SkyKind : uint8_t { kPlain, kOvercast, kClear };

constexpr double kRadians = std::numbers::pi / 180;  // of a degree
// What a clear or an overcast sky of a usual day brings to a horizontal plane without the sun, W/m2.
constexpr Rgb kDaylight(100);

void report(const Context& context, uint32_t node, std::string_view slug, std::string message) {
  add_error(context.messages, place_of(context.tree, node), slug, std::move(message));
}

uint32_t map_node(const Context& context, const MapValues& map, std::string_view key) {
  const uint32_t node = value_of(map, key).node;
  return node != kNone && context.tree.nodes[node].kind == NodeKind::kMap ? node : kNone;
}

// x is east, -z north, so that azimuths run clockwise seen from above. The map has both angles.
DVec3 find_direction(const MapValues& map) {
  const double azimuth = value_of(map, "azimuth").number[0] * kRadians;
  const double elevation = value_of(map, "elevation").number[0] * kRadians;
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          -std::cos(elevation) * std::cos(azimuth)};
}

// Unit, towards the sun.
bool read_sun_direction(const Context& context, const MapValues& map, DVec3& direction) {
  if (!has(map, "direction")) {
    direction = find_direction(map);
    return true;
  }
  if (const uint32_t node = map_node(context, map, "direction"); node != kNone) {
    const MapValues angles = read_map(context, node, kSunDirectionKeys);
    if (angles.good) direction = find_direction(angles);
    return angles.good;
  }
  Value value = value_of(map, "direction");
  return read_three(context, value.node, "expected-vec3", value.number) &&
         read_direction(context, value, direction);
}

bool read_sun(const Context& context, uint32_t node, Sky& sky, DVec3& direction) {
  const MapValues map = read_map(context, node, kSunKeys);
  if (!map.good || !read_sun_direction(context, map, direction)) return false;
  const double radius = value_of(map, "angle").number[0] / 2 * kRadians;
  sky.sun_direction = Vec3(direction);
  sky.sun_radius = static_cast<float>(radius);
  // A surface that faces the disc receives its emission times the sine of its radius, squared.
  sky.sun_emission = has(map, "irradiance")
                         ? Rgb(vec3_of(value_of(map, "irradiance")) / std::pow(std::sin(radius), 2))
                         : Rgb(vec3_of(value_of(map, "emission")));
  if (sky.has_sun() && direction.y < 0)
    add_warning(context.messages, place_of(context.tree, node), "sun-below-horizon",
                "the sun stands below the horizon and lights what faces down; 'direction' points from the "
                "scene towards the sun");
  return true;
}

// Keys of a sky that its kind does not take.
bool check_kind(const Context& context, const MapValues& map, SkyKind kind) {
  const std::string_view name = kind == kOvercast ? "overcast" : "clear";
  for (const std::string_view key : {"zenith", "horizon"})
    if (kind != kPlain && has(map, key)) {
      report(
          context, value_of(map, key).node, "ambiguous-sky",
          fmt::format("a sky of kind '{}' takes 'emission' in place of '{}': what a horizontal plane under "
                      "it receives",
                      name, key));
      return false;
    }
  if (kind == kClear || !has(map, "turbidity")) return true;
  report(context, value_of(map, "turbidity").node, "ambiguous-sky",
         "'turbidity' belongs to a sky of 'kind: clear'");
  return false;
}

// sun: towards it, null where there is none, or where it was wrong.
void read_sky_map(const Context& context, uint32_t node, const DVec3* sun, bool names_sun, Sky& sky) {
  const MapValues map = read_map(context, node, kSkyKeys);
  if (!map.good) return;
  const auto kind = static_cast<SkyKind>(value_of(map, "kind").integer[0]);
  if (!check_kind(context, map, kind)) return;
  if (kind == kPlain && !has(map, "emission") && !has(map, "zenith"))
    return report(context, node, "missing-key", "a plain sky wants 'emission', or 'zenith' and 'horizon'");
  const Rgb emission = has(map, "emission") ? Rgb(vec3_of(value_of(map, "emission"))) : kDaylight;
  Sky read = make_uniform_sky(emission);
  if (has(map, "zenith")) {
    read.zenith = Rgb(vec3_of(value_of(map, "zenith")));
    read.horizon = Rgb(vec3_of(value_of(map, "horizon")));
  }
  if (kind == kOvercast) read = make_overcast_sky(emission);
  if (kind == kClear && sun == nullptr) {
    if (!names_sun)
      report(context, node, "missing-key",
             "a clear sky goes by where the sun is: add 'sun: {azimuth: 150, elevation: 40, irradiance: 0}'");
    return;
  }
  if (kind == kClear && sun->y < 0)
    return report(context, node, "out-of-range",
                  fmt::format("a clear sky is known for a sun above the horizon, and this one stands {:.3g} "
                              "degrees below it",
                              -std::asin(sun->y) / kRadians));
  if (kind == kClear && largest(emission) > 0)
    read = make_clear_sky(value_of(map, "turbidity").number[0], *sun, emission);
  sky.zenith = read.zenith, sky.horizon = read.horizon, sky.clear = read.clear;
  sky.ground = Rgb(vec3_of(value_of(map, "ground")));
}

}  // namespace

void read_sky(const Context& context, const MapValues& scene_keys, Scene& scene) {
  DVec3 sun(0, 1, 0);
  const uint32_t sun_node = map_node(context, scene_keys, "sun");
  const bool has_sun = sun_node != kNone && read_sun(context, sun_node, scene.sky, sun);
  if (const uint32_t node = map_node(context, scene_keys, "sky"); node != kNone)
    read_sky_map(context, node, has_sun ? &sun : nullptr, has(scene_keys, "sun"), scene.sky);
}

}  // namespace patchlight
