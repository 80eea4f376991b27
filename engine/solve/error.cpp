// What the columns of a solution tell of their errors, added up.
#include "engine/solve/error.h"

#include "engine/solve/solution.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

// How far each leaf's value is from the mean of the surface over it: where light bends more than the patches
// follow, or has an edge, that is as much as the surface is off inside.
std::vector<float> find_misfit(const LeafSurface& surface, std::span<const Rgb> leaf_values,
                               const ReconstructSettings& settings) {
  const std::vector<Rgb> values = reconstruct(surface, leaf_values, settings);
  std::vector<float> misfit(leaf_values.size());
  for_rows(misfit.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row)
      misfit[row] = std::abs(mean_channel(leaf_values[row] - leaf_mean(surface, values, row)));
  });
  return misfit;
}

}  // namespace

double ErrorParts::estimate() const {
  return std::sqrt(noise_direct * noise_direct + noise_rows * noise_rows + mesh * mesh);
}

ErrorTable find_error(const Solution& s) {
  const WorkersScope scope(s.workers);
  const FaceTable& faces = s.surfaces->faces;
  ErrorTable table;
  const size_t polygon_count = faces.size() ? size_t{faces.polygon.back()} + 1 : 0;
  table.polygon.resize(polygon_count);
  table.polygon_area.resize(polygon_count);
  if (s.log.passes.empty() || s.light.smooth_error.empty()) return table;

  double sent = 0;  // by all surfaces
  const LeafSurface elements{s.mesh.element_vertices, s.mesh.elements, s.surfaces->frames};
  const std::vector<float> sharp_misfit = find_misfit(elements, s.light.sharp, kDirectSurface);
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    const uint32_t face = s.mesh.elements.face[row], polygon = faces.polygon[face];
    const double area = double{s.mesh.elements.area[row]} * s.mesh.elements.exposed[row];
    const double shown = area * mean_channel(faces.reflectance[face]);
    sent += area * mean_channel(s.mesh.elements.radiosity[row] - faces.emission[face]);
    table.polygon_area[polygon] += area;
    table.polygon[polygon].noise_direct += kMeanOfError * shown * s.light.direct_error[row];
    table.polygon[polygon].mesh += shown * sharp_misfit[row];
  }
  const std::vector<float> smooth_misfit = find_misfit(patch_surface(s), s.light.smooth, kIndirectSurface);
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    const uint32_t face = s.mesh.patches.face[p], polygon = faces.polygon[face];
    const double shown =
        double{s.mesh.patches.area[p]} * s.mesh.patches.exposed[p] * mean_channel(faces.reflectance[face]);
    const double noise = s.light.smooth_error[p], misfit = smooth_misfit[p];
    table.polygon[polygon].noise_rows += kMeanOfError * shown * noise;
    // Noise does not fit either: it is told above.
    table.polygon[polygon].mesh += shown * std::sqrt(std::max(misfit * misfit - noise * noise, 0.0));
  }
  if (sent <= 0) return {{}, std::vector<ErrorParts>(polygon_count), table.polygon_area};
  for (ErrorParts& parts : table.polygon) {
    parts.noise_direct /= sent, parts.noise_rows /= sent, parts.mesh /= sent;
    table.whole.noise_direct += parts.noise_direct;
    table.whole.noise_rows += parts.noise_rows;
    table.whole.mesh += parts.mesh;
  }
  return table;
}

}  // namespace patchlight
