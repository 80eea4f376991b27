// An element and a lamp: how much of the element's sky the lamp fills, and how much of it is seen.
//
// The mean unoccluded factor is exact but for its quadrature; visibility is sum(k V) / sum(k) over pairs of
// points, k the form-factor kernel and V whether they see each other. A plain visible share instead is biased
// for near and large pairs. (Ratio estimators in rendering: Heitz, Hill, McGuire: Combining Analytic Direct
// Illumination and Stochastic Shadows, 2018.)
#pragma once

#include "lamps.h"
#include "tracer.h"

namespace patchlight {

constexpr uint32_t kPacketsMax = 16;  // of pairs for an element and a lamp

// Sixteen points just off an element: a stratum of 4 x 4 each. A packet's samples keep to one of 2 x 2 parts
// of their strata, later packets to finer parts, so that the union of 4 or 16 packets is stratified 8 x 8 or
// 16 x 16.
struct Points {
  float x[kPacketSize], y[kPacketSize], z[kPacketSize];
};

// Which part of a stratum the samples of a packet keep to, by the packet's number.
struct Strata {
  std::array<Vec2, kPacketsMax> base;
  float size = 1;
  explicit Strata(uint32_t packets) : base{} {
    // From the last digit of the packet to the first: each halves what the ones before it left.
    for (uint32_t parts = packets, shift = 0; parts >= 4; parts /= 4, shift += 2) {
      size *= 0.5f;
      for (uint32_t k = 0; k < kPacketsMax; ++k)
        base[k] += size * Vec2(static_cast<float>(k >> shift & 1u), static_cast<float>(k >> shift >> 1 & 1u));
    }
  }
};

// The key of an element's samples.
uint64_t make_element_key(const PatchTable& elements, uint32_t row, uint64_t seed);

// The points of packet `packet` of an element, just off its face.
void make_points(Points& points, const FaceTable& faces, const FaceFrameTable& frames,
                 const PatchTable& elements, uint32_t row, uint64_t key, uint32_t packet,
                 const Strata& strata);
// Which of the points lie inside a solid: a bit a point.
uint32_t find_buried_points(const Points& points, Vec3 normal, const FaceTable& faces, const Tracer& tracer);

// The packets of points of one element, made when first asked for and used for all lamps; open: which are not
// buried.
struct PointPackets {
  std::array<Points, kPacketsMax> points;
  std::array<uint32_t, kPacketsMax> open;
  uint32_t made = 0;
};
// Makes the packets up to `count`.
void make_packets(PointPackets& packets, uint32_t count, const Strata& strata, const PatchTable& elements,
                  const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer, uint32_t row,
                  uint64_t key);

// The element's mean unoccluded factor: at its centre, by Gauss's rule if the lamp is near, at its exposed
// points if part of it is buried (`usable`: which of `points` are not). corners: of the element.
float find_mean_factor(const PatchTable& elements, const FaceFrameTable& frames, uint32_t row, Vec3 normal,
                       const std::array<Vec3, 4>& corners, const Lamp& lamp, const Points& points,
                       uint32_t usable);

struct VisibilitySums {
  float all = 0, seen = 0;         // of the kernel
  uint32_t rays = 0, reached = 0;  // counts
  float share() const { return all > 0 ? seen / all : 0; }
};

// Packets of pairs of an element and a lamp: `unmixed` rays while they agree (there is no shadow edge here
// then), up to `packet_count` packets where some arrive and some do not. Makes the packets of points that it
// lacks.
VisibilitySums find_visibility(PointPackets& packets, uint32_t packet_count, uint32_t unmixed,
                               const Strata& strata, const PatchTable& elements, const Lamp& lamp,
                               const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer,
                               uint32_t row, uint64_t key);

}  // namespace patchlight
