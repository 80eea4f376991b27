// What the columns of a solution tell of their errors, added up.
#include "engine/solve/error.h"

#include "engine/solve/solution.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

// A pass adds no more than this of what the one before added, or light would never end.
constexpr double kRatioMax = 0.99;

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

// What further passes would still add, as a share of what the last one added: passes fall off alike.
double find_tail(std::span<const PassReport> passes) {
  if (passes.size() < 2) return 0;
  const double before = sum_channels(passes[passes.size() - 2].added_power),
               last = sum_channels(passes.back().added_power);
  if (last <= 0 || before <= 0) return 0;
  const double ratio = std::min(last / before, kRatioMax);
  return ratio / (1 - ratio);
}

// Rows of elements, W/m2 of radiosity: errors, and the light that they are shares of.
struct ErrorColumns {
  std::vector<Rgb> noise;  // of direct light; of rows; mesh
  std::vector<Rgb> light;  // what is sent on; what further passes would add of it; unused
};
ErrorColumns find_columns(const Solution& s) {
  const FaceTable& faces = s.surfaces->faces;
  const PatchTable& elements = s.mesh.elements;
  const LeafSurface fine{s.mesh.element_vertices, elements, s.surfaces->frames};
  const std::vector<float> sharp_misfit = find_misfit(fine, s.light.sharp, kDirectSurface);
  const std::vector<float> smooth_misfit = find_misfit(patch_surface(s), s.light.smooth, kIndirectSurface);
  const double tail = find_tail(s.log.passes);
  ErrorColumns columns{std::vector<Rgb>(elements.size()), std::vector<Rgb>(elements.size())};
  for_rows(elements.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const uint32_t face = elements.face[row], p = s.mesh.element_patch[row];
      const float reflectance = mean_channel(faces.reflectance[face]);
      const float noise = s.light.smooth_error[p], misfit = smooth_misfit[p];
      // Noise does not fit either: it is told already.
      const float mesh = sharp_misfit[row] + std::sqrt(std::max(misfit * misfit - noise * noise, 0.0f));
      columns.noise[row] = reflectance * Rgb(static_cast<float>(kMeanOfError) * s.light.direct_error[row],
                                             static_cast<float>(kMeanOfError) * noise, mesh);
      columns.light[row] = {mean_channel(elements.radiosity[row] - faces.emission[face]),
                            static_cast<float>(tail * mean_channel(elements.unshot[row])), 0};
    }
  });
  return columns;
}

// Sums of both columns, weighed, to shares.
struct ErrorSums {
  DRgb noise{0}, light{0};
  void add(double weight, Rgb noise_here, Rgb light_here) {
    noise += weight * DRgb(noise_here), light += weight * DRgb(light_here);
  }
  ErrorParts share_of(double sent) const {
    if (sent <= 0) return {};
    return {noise.r / sent, noise.g / sent, noise.b / sent, light.g / sent};
  }
};

}  // namespace

double ErrorParts::estimate() const {
  return std::sqrt(noise_direct * noise_direct + noise_rows * noise_rows + mesh * mesh + passes * passes);
}

ErrorTable find_error(const Solution& s, std::span<const FilmTable> films) {
  const WorkersScope scope(s.workers);
  const FaceTable& faces = s.surfaces->faces;
  const PatchTable& elements = s.mesh.elements;
  const size_t polygon_count = faces.size() ? size_t{faces.polygon.back()} + 1 : 0;
  ErrorTable table{{}, {}, std::vector<ErrorParts>(polygon_count), std::vector<double>(polygon_count)};
  if (s.log.passes.empty() || s.light.smooth_error.empty()) return table;

  const ErrorColumns columns = find_columns(s);
  std::vector<ErrorSums> polygons(polygon_count);
  ErrorSums all;
  for (size_t row = 0; row < elements.size(); ++row) {
    const uint32_t polygon = faces.polygon[elements.face[row]];
    const double area = double{elements.area[row]} * elements.exposed[row];
    table.polygon_area[polygon] += area;
    polygons[polygon].add(area, columns.noise[row], columns.light[row]);
  }
  for (const ErrorSums& sums : polygons) all.noise += sums.noise, all.light += sums.light;
  for (size_t polygon = 0; polygon < polygon_count; ++polygon)
    table.polygon[polygon] = polygons[polygon].share_of(all.light.r);
  table.shown = table.surfaces = all.share_of(all.light.r);

  const LeafSurface fine{s.mesh.element_vertices, elements, s.surfaces->frames};
  const std::vector<Rgb> noise = reconstruct(fine, columns.noise, {0, 0}),
                         light = reconstruct(fine, columns.light, {0, 0});
  ErrorSums pictures;
  for (const FilmTable& film : films) {
    const std::vector<Rgb> noise_seen = expose(film, noise), light_seen = expose(film, light);
    for (size_t pixel = 0; pixel < noise_seen.size(); ++pixel)
      pictures.add(1.0 / static_cast<double>(noise_seen.size()), noise_seen[pixel], light_seen[pixel]);
  }
  if (pictures.light.r > 0) table.shown = pictures.share_of(pictures.light.r);
  return table;
}

}  // namespace patchlight
