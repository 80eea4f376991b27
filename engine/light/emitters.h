// Faces that emit, or cells that shoot, and how much of a point's sky they fill.
#pragma once

#include "engine/mesh/cell.h"

#include <vector>

namespace patchlight {

inline constexpr float kGauss[2] = {0.21132487f, 0.78867513f};  // Gauss's points of [0, 1] for two

// A planar piece of a face that sends light: the whole face, or a cell of it.
struct Emitter {
  uint32_t face;
  CellFrame cell;  // its place on the face
  uint64_t key;    // of the samples on it
  Vec3 centre, normal;
  std::array<Vec3, 4> corners;
  uint32_t corner_count;
  float area, diameter;
  Vec2 twist;  // of the bilinear map in the basis of its edges: the Jacobian is 1 + v x + u y
  bool is_parallelogram;
  std::array<Vec3, 4> gauss;  // points of Gauss's rule, exact to the third degree; parallelograms only
};

Emitter make_emitter(const FaceTable& faces, const FaceFrameTable& frames, const CellName& name);
// All faces that emit, in their order.
std::vector<Emitter> make_emitters(const FaceTable& faces, const FaceFrameTable& frames);

// The unoccluded form factor from a point to the emitter.
float find_point_factor(Vec3 point, Vec3 normal, const Emitter& emitter);

// Can any point of the patch be lit by the emitter at all, blockers aside?
bool can_reach(const std::array<Vec3, 4>& patch, Vec3 normal, const Emitter& emitter);

}  // namespace patchlight
