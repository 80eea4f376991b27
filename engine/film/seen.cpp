// Points of a picture to rays, hits to elements. Neighbouring samples mostly see one face, and one element of
// it: then all is done for sixteen lanes at once, with the very operations that single lanes take, so that
// the result is the same, bit by bit.
#include "engine/film/seen.h"

#include "engine/base/sampling.h"
#include "engine/mesh/quadtree.h"

#include <bit>
#include <limits>

namespace patchlight {
namespace {

constexpr uint32_t kBackSidesMax = 64;  // back sides that one ray may look through
constexpr uint32_t kAll = 0xffff;

uint32_t find_element_near(const PatchTable& elements, uint32_t face, uint32_t cell, uint32_t guess) {
  if (guess != kNone && elements.face[guess] == face && cell >= elements.cell[guess] &&
      cell - elements.cell[guess] < cell_span(elements.level[guess]))
    return guess;
  return find_leaf(elements, face, cell);
}

// Lens::find_direction of a flat picture, column by column: a tenth of the time of a film.
void aim_flat(RayPacket& r, const Vec2 (&at)[kPacketSize], const Lens& lens) {
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float x = 2 * at[k].x / lens.width - 1, y = 1 - 2 * at[k].y / lens.height;
    const float way_x = lens.forward.x + x * lens.right.x + y * lens.up.x;
    const float way_y = lens.forward.y + x * lens.right.y + y * lens.up.y;
    const float way_z = lens.forward.z + x * lens.right.z + y * lens.up.z;
    const float inverse = 1 / std::sqrt(way_x * way_x + way_y * way_y + way_z * way_z);
    r.direction_x[k] = way_x * inverse, r.direction_y[k] = way_y * inverse,
    r.direction_z[k] = way_z * inverse;
  }
}

// Sets the rays; returns which of them there are.
uint32_t aim(HitPacket& packet, const Vec2 (&at)[kPacketSize], const Lens& lens) {
  uint32_t active = kAll;
  RayPacket& r = packet.ray;
  const bool flat = lens.projection->is_flat;
  if (flat) aim_flat(r, at, lens);
  for (uint32_t k = 0; !flat && k < kPacketSize; ++k) {
    if (!lens.covers(at[k])) active &= ~(1u << k);
    const Vec3 direction = active >> k & 1u ? lens.find_direction(at[k]) : lens.forward;
    r.direction_x[k] = direction.x, r.direction_y[k] = direction.y, r.direction_z[k] = direction.z;
  }
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    r.origin_x[k] = lens.eye.x, r.origin_y[k] = lens.eye.y, r.origin_z[k] = lens.eye.z;
    r.near_distance[k] = 0, r.far_distance[k] = std::numeric_limits<float>::infinity();
  }
  return active;
}

// True if all lanes lie in element `guess` of a quad.
bool all_in(const Seen& seen, const PatchTable& elements, uint32_t guess) {
  constexpr float kSteps = 1u << kLevelMax;
  const CellFrame cell = make_cell_frame(false, elements.cell[guess], elements.level[guess]);
  const auto x = static_cast<int32_t>(cell.origin.x * kSteps),
             y = static_cast<int32_t>(cell.origin.y * kSteps);
  const uint32_t shift = kLevelMax - elements.level[guess];
  int32_t differing = 0;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const auto step_x = static_cast<int32_t>(std::clamp(seen.u[k] * kSteps, 0.0f, kSteps - 1));
    const auto step_y = static_cast<int32_t>(std::clamp(seen.v[k] * kSteps, 0.0f, kSteps - 1));
    differing |= (step_x ^ x) | (step_y ^ y);
  }
  return differing >> shift == 0;
}

// Where on their face, the one that all of them met, and how far away.
void find_parameters(Seen& seen, const HitPacket& packet, uint32_t face, const Lens& lens,
                     const FaceFrameTable& frames) {
  const RayPacket& r = packet.ray;
  const Vec3 origin = frames.origin[face], dual_u = frames.dual_u[face], dual_v = frames.dual_v[face];
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float far = r.far_distance[k];
    const float x = lens.eye.x + far * r.direction_x[k] - origin.x;
    const float y = lens.eye.y + far * r.direction_y[k] - origin.y;
    const float z = lens.eye.z + far * r.direction_z[k] - origin.z;
    seen.u[k] = x * dual_u.x + y * dual_u.y + z * dual_u.z;
    seen.v[k] = x * dual_v.x + y * dual_v.y + z * dual_v.z;
    seen.distance[k] = far;
  }
  if (frames.affine[face]) return;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const Vec2 uv = undo_twist(frames, face, {seen.u[k], seen.v[k]});
    seen.u[k] = uv.x, seen.v[k] = uv.y;
  }
}

// All rays met nothing, or the lit side of one face: true, and what they see is found. False: nothing is
// done.
bool see_one_face(Seen& seen, uint32_t& guess, const HitPacket& packet, const Prospect& prospect) {
  const auto& [lens, surfaces, elements] = prospect;
  const FaceFrameTable& frames = surfaces.frames;
  const uint32_t face = packet.face[0];
  uint32_t differing = 0;
  for (uint32_t k = 0; k < kPacketSize; ++k) differing |= packet.face[k] ^ face;
  if (differing != 0) return false;
  if (face == kNone) {
    seen.left = kAll;
    return true;
  }
  const RayPacket& r = packet.ray;
  const Vec3 normal = surfaces.faces.normal[face];
  float facing_most = -1;
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float facing =
        r.direction_x[k] * normal.x + r.direction_y[k] * normal.y + r.direction_z[k] * normal.z;
    facing_most = std::max(facing_most, facing);
  }
  if (facing_most >= 0) return false;
  find_parameters(seen, packet, face, lens, frames);
  const bool triangle = frames.triangle[face];
  if (!triangle && guess != kNone && elements.face[guess] == face && all_in(seen, elements, guess)) {
    for (uint32_t k = 0; k < kPacketSize; ++k) seen.element[k] = guess;
    return true;
  }
  for (uint32_t k = 0; k < kPacketSize; ++k)
    seen.element[k] = guess =
        find_element_near(elements, face, find_cell(triangle, {seen.u[k], seen.v[k]}), guess);
  return true;
}

}  // namespace

uint64_t find_seen(Seen& seen, uint32_t& guess, const Vec2 (&at)[kPacketSize], const Prospect& prospect) {
  const auto& [lens, surfaces, elements] = prospect;
  const FaceTable& faces = surfaces.faces;
  const FaceFrameTable& frames = surfaces.frames;
  HitPacket packet;
  uint32_t active = aim(packet, at, lens);
  for (uint32_t k = 0; k < kPacketSize; ++k) seen.element[k] = kNone;
  seen.left = 0;
  uint64_t rays = 0;
  for (uint32_t through = 0; active && through < kBackSidesMax; ++through) {
    find_hits(surfaces.tracer, packet, active);
    rays += static_cast<uint64_t>(std::popcount(active));
    if (active == kAll && see_one_face(seen, guess, packet, prospect)) break;
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      if (!(active >> k & 1u)) continue;
      const uint32_t face = packet.face[k];
      RayPacket& r = packet.ray;
      const Vec3 direction(r.direction_x[k], r.direction_y[k], r.direction_z[k]);
      const bool is_back = face != kNone && dot(direction, faces.normal[face]) >= 0;
      if (is_back && !lens.projection->hides_backs) {
        // Go on just behind it.
        const float reached = r.far_distance[k];
        r.near_distance[k] = reached + 2 * ray_offset(lens.eye + reached * direction);
        r.far_distance[k] = std::numeric_limits<float>::infinity();
        continue;
      }
      active &= ~(1u << k);
      if (face == kNone) seen.left |= 1u << k;
      if (face == kNone || is_back) continue;
      const Vec2 uv = find_face_parameters(frames, face, lens.eye + r.far_distance[k] * direction);
      seen.u[k] = uv.x, seen.v[k] = uv.y, seen.distance[k] = r.far_distance[k];
      seen.element[k] = guess =
          find_element_near(elements, face, find_cell(frames.triangle[face], uv), guess);
    }
  }
  return rays;
}

}  // namespace patchlight
