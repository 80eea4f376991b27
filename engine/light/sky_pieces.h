// The sky and the sun as emitters without a place: cells of the sphere of directions.
//
// Cells are spherical triangles, between great circles: what one brings to a plane is Lambert's closed form,
// and they cover the half of the sky above any plane without gap or overlap.
#pragma once

#include "engine/sky.h"
#include "engine/trace/tracer.h"

#include <span>
#include <vector>

namespace patchlight {

// A row a cell, and one for the sun at the end.
struct SkyPieces {
  std::vector<std::array<Vec3, 3>> corners;     // unit, counter-clockwise from within; zero for the sun
  std::vector<Rgb> emission;                    // W/m2, mean
  std::vector<std::array<Vec3, 3>> irradiance;  // W/m2: dot(irradiance[channel], normal) is what a plane gets
                                                // whose horizon does not cut the cell
  // CSR: row -> cells that share a corner with it.
  std::vector<uint32_t> beside_first, beside;
  bool has_sun = false;
  size_t size() const { return emission.size(); }
  bool is_sun(size_t row) const { return has_sun && row + 1 == size(); }
};
// How fine: each face of an octahedron is cut along its edges into so many. 1024 cells above the horizon, 4
// to 5 degrees wide; or 4096, for scenes that see the sky through windows.
enum class SkyDetail : uint8_t { kCoarse = 16, kFine = 32 };
// Cells where the sky is not black. Each 64 from a multiple of 64 on are a triangle of their own.
SkyPieces make_sky_pieces(const Sky& sky, SkyDetail detail = SkyDetail::kCoarse);

// What a plane receives of each piece if nothing is in the way. Kept while the normal is the same.
struct SkyIrradiance {
  Vec3 normal{0};
  std::vector<Rgb> irradiance;  // a row a piece, W/m2
  std::vector<float> strength;  // its luminance
  std::vector<uint8_t> known;   // a row a block of 64 pieces
};
// Finds the rows [first, last), which begin a block and lie in it.
void find_sky_irradiance(SkyIrradiance& out, const SkyPieces& pieces, const Sky& sky, Vec3 normal,
                         uint32_t first, uint32_t last);

// The share of the hemisphere about the normal, weighted with the cosine, that a disc of that angular radius
// fills, of any size up to a right angle; cosine: of the angle between the normal and the disc's middle.
double find_disc_factor(double cosine, double radius);

// A direction to a piece, not unit, and the weight that makes such directions even in the solid angle.
struct SkySample {
  Vec3 direction;
  float weight;
};
// `sample`: of the unit square.
SkySample sample_sky(const SkyPieces& pieces, const Sky& sky, uint32_t row, Vec2 sample);
// Turns rays to the pieces `piece` and on for ever. u, v: samples of the unit square, uniform. sent: what
// comes from there over the density of the sample, over the length of the direction (W/m2, luminance): times
// the dot product with a normal it is what a plane gets.
void aim_at_sky(RayPacket& rays, std::span<float, kPacketSize> sent, const SkyPieces& pieces, const Sky& sky,
                std::span<const uint32_t, kPacketSize> piece, std::span<const float, kPacketSize> u,
                std::span<const float, kPacketSize> v);

}  // namespace patchlight
