// Rows of patches to sums and differences between polygons.
#include "tools/export/health.h"

#include "engine/base/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

constexpr double kLeakMost = 0.01;

bool has_rows(const Solution& solution) {
  return solution.transport.receivers.receiver_of.size() == solution.mesh.patches.size() &&
         solution.transport.hits.size() > 0;
}

std::string format_point(const Scene& scene, Vec3 p) {
  const DVec3 point = scene.origin + DVec3(p) * scene.units_per_length;
  // Corners are floats of engine lengths: what is below their last place is no part of them.
  const auto round = [&](double x) { return std::abs(x) < 1e-6 * scene.units_per_length ? 0.0 : x; };
  return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", round(point.x), round(point.y), round(point.z));
}

}  // namespace

std::vector<double> find_row_sums(const Solution& solution, const FaceTable& faces, size_t polygon_count) {
  const PatchTable& patches = solution.mesh.patches;
  const HitTable& hits = solution.transport.hits;
  std::vector<double> area(polygon_count, 0), met(polygon_count, 0);
  if (has_rows(solution))
    for (size_t patch = 0; patch < patches.size(); ++patch) {
      const size_t row = solution.transport.receivers.receiver_of[patch];
      const uint32_t cast = hits.valid_count(row), hit = cast - hits.nothing[row];
      if (cast == 0) continue;
      const uint32_t polygon = faces.polygon[patches.face[patch]];
      area[polygon] += patches.area[patch];
      met[polygon] += patches.area[patch] * static_cast<double>(hit) / static_cast<double>(cast);
    }
  for (size_t polygon = 0; polygon < polygon_count; ++polygon)
    met[polygon] = area[polygon] > 0 ? std::min(met[polygon] / area[polygon], 1.0) : -1;
  return met;
}

std::vector<double> find_reciprocity_errors(const Solution& solution, const FaceTable& faces,
                                            size_t polygon_count) {
  const PatchTable& patches = solution.mesh.patches;
  const HitTable& hits = solution.transport.hits;
  if (!has_rows(solution) || hits.patch.empty() || polygon_count > kReciprocityMax) return {};
  const size_t n = polygon_count;
  std::vector<double> area(n, 0), exchange(n * n, 0);
  // Faces stand polygon by polygon, and patches face by face.
  const auto first_patch = [&](size_t polygon) {
    const auto face = std::lower_bound(faces.polygon.begin(), faces.polygon.end(), polygon);
    return patches.face_first[static_cast<size_t>(face - faces.polygon.begin())];
  };
  for_rows(n, 1, [&](size_t begin, size_t end) {
    for (size_t polygon = begin; polygon < end; ++polygon)
      for (uint32_t p = first_patch(polygon); p < first_patch(polygon + 1); ++p) {
        const size_t row = solution.transport.receivers.receiver_of[p];
        const uint32_t valid = hits.valid_count(row);
        const double exposed_area = double{patches.area[p]} * patches.exposed[p];
        area[polygon] += exposed_area;
        if (valid == 0) continue;
        for (size_t k = 0; k < hits.ray_count; ++k)
          if (const uint32_t other = hits.patch[row * hits.ray_count + k]; other < kHitBuried)
            exchange[polygon * n + faces.polygon[patches.face[other]]] += exposed_area / valid;
      }
  });
  std::vector<double> errors(n, 0);
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < i; ++j) {
      const double least = std::min(area[i], area[j]);
      if (least <= 0) continue;
      const double error = std::abs(exchange[i * n + j] - exchange[j * n + i]) / least;
      errors[i] = std::max(errors[i], error), errors[j] = std::max(errors[j], error);
    }
  return errors;
}

Health find_health(const Scene& scene, const Solution& solution) {
  const size_t polygons = scene.polygons.size();
  return {find_row_sums(solution, scene.faces, polygons),
          find_reciprocity_errors(solution, scene.faces, polygons), find_leaks(solution)};
}

std::vector<Diagnostic> describe_leaks(const Scene& scene, const LeakReport& leaks) {
  if (leaks.through_cracks <= kLeakMost || leaks.face == kNone) return {};
  const uint32_t polygon = scene.faces.polygon[leaks.face];
  const auto& corners = scene.faces.corners[leaks.face];
  Diagnostic warning;
  warning.severity = Severity::kWarning;
  warning.file = scene.file;
  warning.slug = "light-leak";
  warning.message = fmt::format(
      "{:.1f} % of the light leaves through cracks, most of it past the edge of '{}' from {} to {} (line "
      "{}): what is "
      "to be closed must share whole edges",
      100 * leaks.through_cracks, escape_text(scene.polygons.id[polygon]),
      format_point(scene, corners[leaks.edge]),
      format_point(scene, corners[(leaks.edge + 1) % scene.faces.corner_count[leaks.face]]),
      scene.polygons.line[polygon]);
  return {warning};
}

}  // namespace patchlight
