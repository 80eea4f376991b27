// Sums over elements, object by object.
#include "tools/export/object_power.h"

namespace patchlight {

ObjectPowerTable find_object_power(const Scene& scene, const Solution& solution) {
  const size_t count = scene.object_ids.size();
  const double metres_per_length = scene.metres_per_length();
  ObjectPowerTable power{std::vector<double>(count, 0), std::vector<DRgb>(count, DRgb(0)),
                         std::vector<DRgb>(count, DRgb(0)), std::vector<DRgb>(count, DRgb(0))};
  const PatchTable& elements = solution.mesh.elements;
  const std::vector<Rgb> irradiance = element_irradiance(solution);
  for (size_t row = 0; row < elements.size(); ++row) {
    const uint32_t face = elements.face[row], object = scene.polygons.object[scene.faces.polygon[face]];
    const double area =
        double{elements.area[row]} * elements.exposed[row] * metres_per_length * metres_per_length;
    const DRgb received = area * DRgb(irradiance[row]);
    power.area[object] += area;
    power.emitted[object] += area * DRgb(scene.faces.emission[face]);
    power.received[object] += received;
    power.absorbed[object] += (DRgb(1) - DRgb(scene.faces.reflectance[face])) * received;
  }
  return power;
}

}  // namespace patchlight
