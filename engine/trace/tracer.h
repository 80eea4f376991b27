// The one door to Embree: rays against the scene's faces.
#pragma once

#include "engine/tables.h"

#include <cstdint>
#include <memory>

namespace patchlight {

constexpr uint32_t kPacketSize = 16;
// Embree takes coordinates up to here, in lengths.
constexpr float kTracedCoordinateMax = 1.8e18f;

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
  uint32_t instance_primitive[16];  // Embree 4.3 and later write it
};

// Which of sixteen values are above 0: a bit each. Not by shifts: gcc 12 with -fsanitize=shift turns such a
// loop into a test of the first value alone.
template <typename Values>
uint32_t find_positive(const Values& values) {
  uint32_t bits = 0;
  for (uint32_t k = kPacketSize; k-- > 0;) bits = 2 * bits + (values[k] > 0 ? 1 : 0);
  return bits;
}

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

// Told of every packet that find_hits and find_blocked are asked for. On one thread only.
struct RayObserver {
  virtual void see_nearest(const RayPacket& packet, uint32_t active) = 0;
  virtual void see_visibility(const RayPacket& packet, uint32_t active) = 0;

 protected:
  ~RayObserver() = default;
};
// Null: nobody any longer.
void observe_rays(const Tracer& tracer, RayObserver* observer);

// Embree's own calls and nothing else, to measure how long they take. valid: -1 for a ray that counts, 0 for
// others, aligned to 64 bytes; all columns that Embree reads must be set.
void trace_nearest(const Tracer& tracer, const int* valid, HitPacket& packet, RayOrder order);
void trace_blocked(const Tracer& tracer, const int* valid, RayPacket& packet, RayOrder order);

// The name and version of the library, for --version.
const char* tracer_version();

}  // namespace patchlight
