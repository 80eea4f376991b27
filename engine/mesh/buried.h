// Rays that met back sides, and which of them started inside a solid.
#pragma once

#include "engine/base/sampling.h"
#include "engine/mesh/surfaces.h"

namespace patchlight {

// Those of the rays `active` that met a back side: a bit a ray.
inline uint32_t find_backs(const HitPacket& packet, const FaceTable& faces, uint32_t active) {
  const RayPacket& r = packet.ray;
  uint32_t back = 0;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    if (!(active >> k & 1u) || packet.face[k] == kNone) continue;
    const Vec3 direction(r.direction_x[k], r.direction_y[k], r.direction_z[k]);
    if (dot(direction, faces.normal[packet.face[k]]) >= 0) back |= 1u << k;
  }
  return back;
}

// Of the rays' origins (points just off the face with this frame), those that lie inside a solid: from there
// only back sides are seen, along the normal and in six directions about it.
uint32_t find_buried(const Surfaces& surfaces, const Frame& frame, const RayPacket& rays, uint32_t active);

}  // namespace patchlight
