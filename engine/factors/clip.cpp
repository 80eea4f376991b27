// Outlines cut at a plane.
#include "engine/factors/clip.h"

#include <cassert>

namespace patchlight {

void clip_outline(std::vector<Segment>& kept, std::span<const Segment> outline, const HalfSpace& space) {
  std::vector<DVec3> left, entered;
  for (const auto& [a, b] : outline) {
    const double height_a = height_above(space, a), height_b = height_above(space, b);
    const bool above_a = height_a >= 0, above_b = height_b >= 0;
    if (above_a && above_b) kept.push_back({a, b});
    if (above_a == above_b) continue;
    const DVec3 crossing = a + (height_a / (height_a - height_b)) * (b - a);
    if (above_a) {
      kept.push_back({a, crossing});
      left.push_back(crossing);
    } else {
      kept.push_back({crossing, b});
      entered.push_back(crossing);
    }
  }
  assert(left.size() == entered.size());
  for (size_t k = 0; k < left.size(); ++k) kept.push_back({left[k], entered[k]});
}

}  // namespace patchlight
