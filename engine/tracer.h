// The one door to Embree: rays against the scene's faces.
#pragma once

#include "tables.h"

#include <cstdint>
#include <memory>

namespace patchlight {

constexpr uint32_t kPacketSize = 16;

// Sixteen rays; the layout is Embree's own (checked in tracer.cpp), so that nothing is copied.
struct alignas(64) RayPacket {
  float origin_x[16], origin_y[16], origin_z[16];  // lengths
  float near_distance[16];                         // in units of the direction's length
  float direction_x[16], direction_y[16], direction_z[16];
  float time[16];
  float
      far_distance[16];  // where the ray ends; after a hit, where it hit; after find_blocked, -inf if blocked
  uint32_t mask[16], id[16], flags[16];
};

struct alignas(64) HitPacket {
  RayPacket ray;
  float normal_x[16], normal_y[16], normal_z[16];  // not unit; the face's own winding decides the side
  float u[16], v[16];
  uint32_t face[16];  // kNone: nothing hit
  uint32_t geometry[16];
  uint32_t instance[16];
  uint32_t instance_primitive[16];  // Embree 4.3 and later; older ones end before it
};

struct TracerState;
struct Tracer {
  std::unique_ptr<TracerState, void (*)(TracerState*)> state;
};

// Builds Embree's scene of all faces; from then on it never changes. Throws std::runtime_error with Embree's
// words.
Tracer make_tracer(const FaceTable& faces);

// Nearest hit of the rays of `active` (bit k: ray k). Rays must be finite.
void find_hits(const Tracer& tracer, HitPacket& packet, uint32_t active);
// Which of its kernels Embree is told to take: for rays that stay together, or for rays that part.
enum class RayOrder { kCoherent, kIncoherent };
// Which of the rays of `active` are blocked before far_distance: a bit a ray.
uint32_t find_blocked(const Tracer& tracer, RayPacket& packet, uint32_t active,
                      RayOrder order = RayOrder::kCoherent);

// The name and version of the library, for --version.
const char* tracer_version();

}  // namespace patchlight
