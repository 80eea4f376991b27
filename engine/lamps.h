// Faces that emit, and how much of a point's sky they fill.
#pragma once

#include "cell.h"

#include <vector>

namespace patchlight {

inline constexpr float kGauss[2] = {0.21132487f, 0.78867513f};  // Gauss's points of [0, 1] for two

struct Lamp {
  uint32_t face;
  Vec3 centre, normal;
  std::array<Vec3, 4> corners;
  uint32_t corner_count;
  float area, diameter;
  Vec2 twist;  // of the bilinear map in the basis of its edges: the Jacobian is 1 + v x + u y
  bool is_parallelogram;
  std::array<Vec3, 4> gauss;  // points of Gauss's rule, exact to the third degree; parallelograms only
};

// All faces that emit, in their order.
std::vector<Lamp> make_lamps(const FaceTable& faces, const FaceFrameTable& frames);

// The unoccluded form factor from a point to the lamp.
float find_factor(Vec3 point, Vec3 normal, const Lamp& lamp);

// Can any point of the patch be lit by the lamp at all, blockers aside?
bool can_reach(const std::array<Vec3, 4>& patch, Vec3 normal, const Lamp& lamp);

}  // namespace patchlight
