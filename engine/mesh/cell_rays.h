// Rays from cells: even over the cell, with cosine density over its directions.
#pragma once

#include "engine/base/sampling.h"
#include "engine/mesh/cell.h"
#include "engine/tables.h"
#include "engine/trace/tracer.h"

namespace patchlight {

// What samples are for: those of different purposes are unrelated.
enum RayPurpose : uint32_t {
  kProbeRays = 1,
  kRowRays,
  kDirectRays,
  kAimedRays,
  kAimedProbeRays,
  kEmissionRays,
  kShareRays,
  kLeakRays,
  kSightRays,
  kReachRays,
  kSkyRays
};

// Directions: columns x rows strata of the unit square, 4 x 4 of which go into one packet. Origins take the
// strata of the other axis, permuted by a lattice: stratum k goes with k * step modulo their number.
struct RayGrid {
  uint32_t columns = 4, rows = 4;  // both multiples of 4
  uint32_t column_step = 1, row_step = 1;
  uint32_t packet_count() const { return columns * rows / 16; }
  uint32_t ray_count() const { return columns * rows; }
};
RayGrid make_ray_grid(uint32_t rays);
// Rays in two halves, a chequerboard over the strata of each packet: k and k ^ 5 are in one, k ^ 1 and k ^ 4
// in the other.
inline uint32_t find_half(size_t k) { return static_cast<uint32_t>((k ^ k >> 2) & 1); }

// Points of the unit square for the sixteen rays of a packet: directions and origins.
struct RaySamples {
  float direction_x[kPacketSize], direction_y[kPacketSize], origin_x[kPacketSize], origin_y[kPacketSize];
};
void make_ray_samples(RaySamples& samples, uint64_t key, const RayGrid& grid, uint32_t packet);

// A direction with density cos / pi about the third axis (Malley's method), from a point of the unit square,
// by a map that keeps strata whole (Shirley, Chiu: A Low Distortion Map Between Disk and Square, 1997). No
// branches, sine and cosine as polynomials (|angle| <= pi / 4, error below 4e-7): a loop over lanes of it
// compiles to wide instructions.
inline Vec3 make_cosine_direction(float px, float py) {
  const float a = 2 * px - 1, b = 2 * py - 1;
  const bool wide = std::abs(a) > std::abs(b);
  const float radius = wide ? a : b, minor = wide ? b : a;
  const float x = kPi / 4 * minor / (radius == 0 ? 1 : radius), xx = x * x;
  const float sine = x * (1 + xx * (-1 / 6.0f + xx * (1 / 120.0f - xx / 5040.0f)));
  const float cosine = 1 + xx * (-0.5f + xx * (1 / 24.0f + xx * (-1 / 720.0f + xx / 40320.0f)));
  const float along = radius * cosine, across = radius * sine;
  const float u = wide ? along : across, v = wide ? across : along;
  return {u, v, std::sqrt(std::max(1 - u * u - v * v, 1e-9f))};
}

// The rays of one cell.
struct CellRays {
  CellName cell;
  Frame frame;
  uint64_t key;
  RayGrid grid;
};
CellRays make_cell_rays(const FaceTable& faces, const CellName& cell, RayPurpose purpose, uint64_t seed,
                        const RayGrid& grid);

// Packet `packet` (of grid.packet_count()): origins spread over the cell, just off its face.
void make_ray_packet(HitPacket& rays, const CellRays& from, const FaceFrameTable& frames, uint32_t packet);

}  // namespace patchlight
