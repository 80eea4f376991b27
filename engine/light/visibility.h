// An element and an emitter: how much of the element's sky it fills, and how much of it is seen.
//
// The mean unoccluded factor is exact but for its quadrature; visibility is sum(k V) / sum(k) over pairs of
// points, k the form-factor kernel and V whether they see each other. A plain visible share instead is biased
// for near and large pairs. (Ratio estimators in rendering: Heitz, Hill, McGuire: Combining Analytic Direct
// Illumination and Stochastic Shadows, 2018.)
#pragma once

#include "engine/light/emitters.h"
#include "engine/mesh/surfaces.h"

namespace patchlight {

constexpr uint32_t kPacketsMax = 64;  // of pairs for an element and an emitter

// Sixteen points just off an element: a stratum of 4 x 4 each. A packet's samples keep to one of 2 x 2 parts
// of their strata, later packets to finer parts, so that the union of 4 or 16 packets is stratified 8 x 8 or
// 16 x 16.
struct Points {
  float x[kPacketSize], y[kPacketSize], z[kPacketSize];
};

// Which part of a stratum the samples of a packet keep to, by the packet's number.
struct Strata {
  std::array<Vec2, kPacketsMax> base;    // of two dimensions: a part's corner ...
  float size = 1;                        // ... and its width
  std::array<float, kPacketsMax> place;  // the same of one dimension, where all digits of a part count
  float place_size = 1;
  explicit Strata(uint32_t packets) : base{} {
    // From the last digit of the packet to the first: each halves what the ones before it left.
    for (uint32_t parts = packets, shift = 0; parts >= 4; parts /= 4, shift += 2) {
      size *= 0.5f;
      for (uint32_t k = 0; k < kPacketsMax; ++k)
        base[k] += size * Vec2(static_cast<float>(k >> shift & 1u), static_cast<float>(k >> shift >> 1 & 1u));
    }
    place_size = 1 / static_cast<float>(packets);
    for (uint32_t k = 0; k < kPacketsMax; ++k) place[k] = place_size * static_cast<float>(k % packets);
  }
};

// One element after the other, and its packets of points: made when first asked for and used for all
// emitters.
struct ElementPoints {
  const Surfaces& surfaces;
  const PatchTable& elements;
  Strata strata;
  uint32_t row = 0;
  std::array<Vec3, 4> corners;
  Vec3 centre, normal;
  float edge = 0;     // the longest
  uint64_t key = 0;   // of the element's samples
  uint32_t made = 0;  // packets
  std::array<Points, kPacketsMax> points;
  std::array<uint32_t, kPacketsMax> open;  // those that do not lie inside a solid: a bit a point
  SkyIrradiance sky;                       // of its face, once asked for
  ElementPoints(const Surfaces& all, const PatchTable& table, uint32_t packets)
      : surfaces(all), elements(table), strata(packets) {}
};
// Goes on to another element. salt: other samples for another purpose.
void start_element(ElementPoints& from, uint32_t row, uint64_t seed, uint64_t salt = 0);
// Makes the packets up to `count`.
void make_packets(ElementPoints& from, uint32_t count);

// The element's mean unoccluded factor: at its centre, by Gauss's rule if the emitter is near, at the points
// `usable` of its first packet if it is partly buried.
float find_mean_factor(const ElementPoints& from, const Emitter& emitter, uint32_t usable);

struct VisibilitySums {
  std::array<float, 2> all = {0, 0}, seen = {0, 0};  // of the kernel, over two halves of the pairs
  uint32_t packets = 0, rays = 0, reached = 0;       // counts
  float share() const { return all[0] + all[1] > 0 ? (seen[0] + seen[1]) / (all[0] + all[1]) : 0; }
  // A sample of its error: half the difference of the halves' shares.
  bool mixed() const { return reached > 0 && reached < rays; }
  // The variance of one pair's V. Where all agree, one more might not have.
  float variance() const {
    const float visible = (static_cast<float>(reached) + 0.5f) / (static_cast<float>(rays) + 1);
    return visible * (1 - visible);
  }
  float noise() const { return all[0] > 0 && all[1] > 0 ? 0.5f * (seen[0] / all[0] - seen[1] / all[1]) : 0; }
};

// Packets of pairs of an element and an emitter: `unmixed` rays while they agree (there is no shadow edge
// here then), up to `packet_count` packets where some arrive and some do not. Makes the packets of points
// that it lacks.
VisibilitySums find_visibility(ElementPoints& from, const Emitter& emitter, uint32_t packet_count,
                               uint32_t unmixed);

// What an element would receive of the pieces of a group that it may see, if nothing were in their way.
struct GroupLook {
  Rgb irradiance;  // W/m2
  float strength;  // its luminance
  uint32_t count;  // pieces that reach it
  std::array<uint8_t, kGroupPiecesMax> piece;
  std::array<float, kGroupPiecesMax> strength_until;  // summed up to each of them
};
void find_unoccluded(GroupLook& look, ElementPoints& from, const EmitterGroups& groups, uint32_t group,
                     uint64_t pieces);

// Adds the packets [first, last) of pairs of an element and a group; rays go to its pieces by what they
// bring. Makes the packets of points that it lacks.
void add_visibility(VisibilitySums& sums, ElementPoints& from, const GroupLook& look,
                    const EmitterGroups& groups, uint32_t group, uint32_t first, uint32_t last);

}  // namespace patchlight
