// A sky to cells; cells and planes to irradiance.
#include "engine/light/sky_pieces.h"

#include "engine/base/sampling.h"
#include "engine/light/lambert.h"
#include "engine/mesh/cell_rays.h"

#include <limits>
#include <map>

namespace patchlight {
namespace {

// Along an edge of the octahedron: cells are cut on, as fine as this, where their emission is summed up.
constexpr int kSumSteps = 64;
constexpr uint32_t kBlock = 64;

// A corner of the net on one octant: its shares of the three axes, of all steps.
using NetPoint = std::array<int, 3>;
using NetCell = std::array<NetPoint, 3>;

// The sines make steps alike in angle, so that cells are alike in size.
DVec3 find_direction(const NetPoint& p, int steps) {
  DVec3 way;
  for (int k = 0; k < 3; ++k) {
    const int share = p[static_cast<size_t>(k)];
    way[k] = std::copysign(std::sin(std::numbers::pi / 2 * std::abs(share) / steps), share);
  }
  return normalize(way);
}

// Lambert's contour sum of a spherical triangle: dot(result, normal) is what it fills of the hemisphere.
DVec3 find_factor_vector(const std::array<DVec3, 3>& corners) {
  DVec3 sum(0);
  for (size_t k = 0; k < 3; ++k) {
    const DVec3 a = corners[k], b = corners[(k + 1) % 3], across = cross(a, b);
    const double sine = length(across);
    if (sine > 0) sum -= std::atan2(sine, dot(a, b)) / sine * across;
  }
  return sum / (2 * std::numbers::pi);
}

void add_cell(SkyPieces& pieces, const NetCell& net, int steps, const Sky& sky) {
  const int parts = kSumSteps / steps;
  std::array<Vec3, 3> rounded;
  for (size_t k = 0; k < 3; ++k) rounded[k] = Vec3(find_direction(net[k], steps));
  pieces.corners.push_back(rounded);
  // Read back: gcc 12 leaves the rounding out otherwise, and its bits are not those of other compilers.
  std::array<DVec3, 3> corner;
  for (size_t k = 0; k < 3; ++k) corner[k] = DVec3(pieces.corners.back()[k]);
  std::array<DVec3, 3> irradiance{};
  DRgb sum(0);
  double weight = 0;
  const auto at = [&](int a, int b) {
    return normalize(double(parts - a - b) * corner[0] + double(a) * corner[1] + double(b) * corner[2]);
  };
  const auto add_part = [&](const DVec3& a, const DVec3& b, const DVec3& c) {
    const DVec3 vector = find_factor_vector({a, b, c});
    const DRgb emission(find_sky_emission(sky, Vec3(normalize(a + b + c))));
    for (int k = 0; k < 3; ++k) irradiance[static_cast<size_t>(k)] += emission[k] * vector;
    sum += length(vector) * emission, weight += length(vector);
  };
  for (int a = 0; a < parts; ++a)
    for (int b = 0; a + b < parts; ++b) {
      add_part(at(a, b), at(a + 1, b), at(a, b + 1));
      if (a + b + 1 < parts) add_part(at(a + 1, b), at(a + 1, b + 1), at(a, b + 1));
    }
  pieces.emission.emplace_back(sum / weight);
  pieces.irradiance.push_back({Vec3(irradiance[0]), Vec3(irradiance[1]), Vec3(irradiance[2])});
}

// The leaves of a triangle of the net, those of each quarter side by side.
void split_net(std::vector<NetCell>& leaves, const NetCell& net, int size) {
  if (size == 1) {
    leaves.push_back(net);
    return;
  }
  NetCell middle;
  for (size_t k = 0; k < 3; ++k)
    for (size_t axis = 0; axis < 3; ++axis) middle[k][axis] = (net[k][axis] + net[(k + 1) % 3][axis]) / 2;
  split_net(leaves, {net[0], middle[0], middle[2]}, size / 2);
  split_net(leaves, {middle[0], net[1], middle[1]}, size / 2);
  split_net(leaves, {middle[2], middle[1], net[2]}, size / 2);
  split_net(leaves, {middle[0], middle[1], middle[2]}, size / 2);
}

void find_beside(SkyPieces& pieces, const std::vector<NetCell>& leaves) {
  std::map<NetPoint, std::vector<uint32_t>> at_corner;
  for (uint32_t row = 0; row < leaves.size(); ++row)
    for (const NetPoint& p : leaves[row]) at_corner[p].push_back(row);
  pieces.beside_first.push_back(0);
  for (uint32_t row = 0; row < leaves.size(); ++row) {
    std::vector<uint32_t> others;
    for (const NetPoint& p : leaves[row])
      for (const uint32_t other : at_corner[p])
        if (other != row) others.push_back(other);
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    pieces.beside.insert(pieces.beside.end(), others.begin(), others.end());
    pieces.beside_first.push_back(static_cast<uint32_t>(pieces.beside.size()));
  }
}

}  // namespace

SkyPieces make_sky_pieces(const Sky& sky, SkyDetail detail) {
  const int steps = static_cast<int>(detail);
  SkyPieces pieces;
  std::vector<NetCell> leaves;
  for (const int up : {1, -1}) {
    if (up > 0 ? !sky.is_lit() : !sky.has_ground()) continue;
    for (const int x : {1, -1})
      for (const int z : {1, -1}) {
        NetCell octant = {NetPoint{x * steps, 0, 0}, NetPoint{0, up * steps, 0}, NetPoint{0, 0, z * steps}};
        // Counter-clockwise from within, as a lit side that looks at the middle.
        if (x * up * z > 0) std::swap(octant[0], octant[2]);
        split_net(leaves, octant, steps);
      }
  }
  for (const auto& leaf : leaves) add_cell(pieces, leaf, steps, sky);
  find_beside(pieces, leaves);
  if (sky.has_sun()) {
    pieces.has_sun = true;
    pieces.corners.push_back({});
    pieces.emission.push_back(sky.sun_emission);
    pieces.irradiance.push_back({});
    pieces.beside_first.push_back(static_cast<uint32_t>(pieces.beside.size()));
  }
  return pieces;
}

// The closed form of a sphere over a tilted plane (Snyder: Area Light Sources for Real-Time Graphics, 1996;
// Howell: A Catalog of Radiation Heat Transfer Configuration Factors).
double find_disc_factor(double cosine, double radius) {
  const double sine_radius = std::sin(radius), squared = sine_radius * sine_radius;
  if (cosine >= sine_radius) return cosine * squared;
  if (cosine <= -sine_radius) return 0;
  const double sine = std::sqrt(1 - cosine * cosine), cosine_radius = std::cos(radius);
  const double edge = std::sqrt(std::max(squared - cosine * cosine, 0.0));
  const double cut = std::clamp(-cosine * cosine_radius / (sine * sine_radius), -1.0, 1.0);
  return std::max(
      (cosine * squared * std::acos(cut) - cosine_radius * edge + std::atan2(edge, cosine_radius)) /
          std::numbers::pi,
      0.0);
}

namespace {

Rgb find_cell_irradiance(const SkyPieces& pieces, uint32_t row, Vec3 normal) {
  const auto& [a, b, c] = pieces.corners[row];
  const float at_a = dot(a, normal), at_b = dot(b, normal), at_c = dot(c, normal);
  const auto& vector = pieces.irradiance[row];
  if (std::min({at_a, at_b, at_c}) >= 0)
    return max(Rgb(dot(vector[0], normal), dot(vector[1], normal), dot(vector[2], normal)), Rgb(0));
  if (std::max({at_a, at_b, at_c}) <= 0) return Rgb(0);
  return static_cast<float>(find_point_form_factor(DVec3(0), DVec3(normal), pieces.corners[row])) *
         pieces.emission[row];
}

}  // namespace

void find_sky_irradiance(SkyIrradiance& out, const SkyPieces& pieces, const Sky& sky, Vec3 normal,
                         uint32_t first, uint32_t last) {
  if (out.normal != normal || out.strength.size() != pieces.size()) {
    out.normal = normal;
    out.irradiance.resize(pieces.size());
    out.strength.resize(pieces.size());
    out.known.assign(pieces.size() / kBlock + 1, 0);
  }
  if (out.known[first / kBlock]) return;
  out.known[first / kBlock] = 1;
  for (uint32_t row = first; row < last; ++row) {
    const double cosine = std::clamp(dot(DVec3(normal), DVec3(sky.sun_direction)), -1.0, 1.0);
    const Rgb value =
        pieces.is_sun(row)
            ? static_cast<float>(find_disc_factor(cosine, double{sky.sun_radius})) * sky.sun_emission
            : find_cell_irradiance(pieces, row, normal);
    out.irradiance[row] = value;
    out.strength[row] = luminance(value);
  }
}

SkySample sample_sky(const SkyPieces& pieces, const Sky& sky, uint32_t row, Vec2 sample) {
  if (pieces.is_sun(row)) {
    const Frame frame = make_frame(sky.sun_direction);
    const Vec3 disc = make_cosine_direction(sample.x, sample.y);
    const float sine = std::sin(sky.sun_radius), x = disc.x * sine, y = disc.y * sine;
    const float along = std::sqrt(std::max(1 - x * x - y * y, 1e-9f));
    return {x * frame.tangent + y * frame.bitangent + along * frame.normal, 1 / along};
  }
  const auto& [a, b, c] = pieces.corners[row];
  const Vec2 uv = cell_sample(true, CellFrame{Vec2(0), 1}, sample);
  const Vec3 p = a + uv.x * (b - a) + uv.y * (c - a);
  // Points are even on the flat triangle: what one stands for goes with the cube of its distance.
  const float squared = dot(p, p);
  return {p, std::abs(dot(cross(b - a, c - a), a)) / (squared * std::sqrt(squared))};
}

void aim_at_sky(RayPacket& rays, std::span<float, kPacketSize> sent, const SkyPieces& pieces, const Sky& sky,
                std::span<const uint32_t, kPacketSize> piece, std::span<const float, kPacketSize> u,
                std::span<const float, kPacketSize> v) {
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const auto [way, weight] = sample_sky(pieces, sky, piece[k], {u[k], v[k]});
    rays.direction_x[k] = way.x, rays.direction_y[k] = way.y, rays.direction_z[k] = way.z;
    rays.near_distance[k] = 0, rays.far_distance[k] = std::numeric_limits<float>::infinity();
    sent[k] = weight * luminance(pieces.emission[piece[k]]) / length(way);
  }
}

}  // namespace patchlight
