// Powers to emissions.
#include "dsl/scene/power.h"

#include "dsl/report/limits.h"
#include "dsl/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace patchlight {
namespace {

// Square metres.
double find_area(const Scene& scene, uint32_t first, uint32_t last) {
  double area = 0;
  for (uint32_t f = first; f < last; ++f) {
    const auto& c = scene.faces.corners[f];
    area += glm::length(glm::cross(DVec3(c[2]) - DVec3(c[0]), DVec3(c[3]) - DVec3(c[1]))) / 2;
  }
  return area * scene.metres_per_length() * scene.metres_per_length();
}

}  // namespace

void share_power(Messages& messages, const Tree& tree, const MaterialTable& materials,
                 const ObjectTable& objects, const OutlineTable& outlines, Scene& scene) {
  struct Share {
    uint32_t first, last;  // rows of scene.polygons
    double area;
  };
  std::map<std::pair<uint32_t, uint32_t>, std::vector<Share>> shares;  // of an object and a material
  uint32_t polygon = 0;
  for (uint32_t p = 0; p < outlines.size(); ++p) {
    const uint32_t object = outlines.object[p], material = outlines.material[p];
    const uint32_t sides = objects.two_sided[object] ? 2 : 1, last = polygon + sides;
    if (materials.by_power[material])
      shares[{object, material}].push_back(
          {polygon, last,
           find_area(scene, scene.polygons.face_first[polygon], scene.polygons.face_first[last])});
    polygon = last;
  }
  for (const auto& [of, parts] : shares) {
    double area = 0;
    for (const Share& share : parts) area += share.area;
    const DRgb power = materials.emission[of.second], emission = power / area;
    const double largest = std::max({emission.r, emission.g, emission.b});
    if (!(area > 0)) continue;
    if (largest > kEmissionMax) {
      add_error(messages, place_of(tree, objects.node[of.first]), "emission-range",
                fmt::format("the power of '{}' on {} m2 is an emission of {} W/m2, more than {}",
                            escape_text(materials.name[of.second]), number_text(area), number_text(largest),
                            number_text(kEmissionMax)));
      continue;
    }
    for (const Share& share : parts)
      for (uint32_t f = scene.polygons.face_first[share.first]; f < scene.polygons.face_first[share.last];
           ++f)
        scene.faces.emission[f] = Rgb(emission);
  }
}

}  // namespace patchlight
