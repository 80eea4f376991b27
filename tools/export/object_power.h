// A solution to what each object of its scene gives and takes: net heat flow, for heat.
#pragma once

#include "dsl/scene/scene.h"
#include "engine/solve/solve.h"

#include <vector>

namespace patchlight {

// A row an entry of the scene's list of objects. Areas m2, exposed ones only; powers W.
struct ObjectPowerTable {
  std::vector<double> area;
  std::vector<DRgb> emitted;   // by its lit sides
  std::vector<DRgb> received;  // on them
  std::vector<DRgb> absorbed;  // the part that is not reflected
  size_t size() const { return area.size(); }
};
ObjectPowerTable find_object_power(const Scene& scene, const Solution& solution);

// What the object loses, W: the rate at which it must be heated (or, below 0, cooled) to keep its
// temperature.
inline DRgb find_net_power(const ObjectPowerTable& power, size_t object) {
  return power.emitted[object] - power.absorbed[object];
}

}  // namespace patchlight
