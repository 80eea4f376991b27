// Origins of rays to those that lie inside a solid.
#include "engine/mesh/buried.h"

#include <limits>

namespace patchlight {

uint32_t find_buried(const Surfaces& surfaces, const Frame& frame, const RayPacket& rays, uint32_t active) {
  // Along the normal, at 60 degrees to it on three sides, at 82 degrees on three more: what lies under a
  // sheet sees out at its sides.
  constexpr float kTurnCosine = -0.5f, kTurnSine = 0.8660254f;
  constexpr float kSteepSine = 0.8660254f, kSteepCosine = 0.5f, kFlatSine = 0.9902681f,
                  kFlatCosine = 0.1391731f;
  constexpr float kAround[7][3] = {{0, 0, 1},
                                   {kSteepSine, 0, kSteepCosine},
                                   {kTurnCosine * kSteepSine, kTurnSine * kSteepSine, kSteepCosine},
                                   {kTurnCosine * kSteepSine, -kTurnSine * kSteepSine, kSteepCosine},
                                   {-kFlatSine, 0, kFlatCosine},
                                   {-kTurnCosine * kFlatSine, kTurnSine * kFlatSine, kFlatCosine},
                                   {-kTurnCosine * kFlatSine, -kTurnSine * kFlatSine, kFlatCosine}};
  for (const auto& local : kAround) {
    if (!active) break;
    const Vec3 direction = local[0] * frame.tangent + local[1] * frame.bitangent + local[2] * frame.normal;
    HitPacket probe;
    probe.ray = rays;
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      probe.ray.direction_x[k] = direction.x, probe.ray.direction_y[k] = direction.y;
      probe.ray.direction_z[k] = direction.z;
      probe.ray.near_distance[k] = 0, probe.ray.far_distance[k] = std::numeric_limits<float>::infinity();
    }
    find_hits(surfaces.tracer, probe, active);
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if (probe.face[k] == kNone || dot(direction, surfaces.faces.normal[probe.face[k]]) < 0)
        active &= ~(1u << k);
  }
  return active;
}

}  // namespace patchlight
