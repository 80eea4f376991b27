// A solution to what is read of it: rows, means, radiosity at corners, irradiance, a hash.
#include "solution.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace patchlight {
namespace {

// Irradiance at the corners of the elements: their direct light, and the surface of `patch_irradiance`.
std::vector<Rgb> find_vertex_radiosity(const Solution& s, const FaceTable& faces, const VertexTable& vertices,
                                       std::span<const Rgb> patch_irradiance, bool with_direct) {
  const std::vector<Rgb> indirect =
      reconstruct(s.patch_vertices, s.patches, s.frames, patch_irradiance, kIndirectSurface);
  std::vector<Rgb> values = with_direct
                                ? reconstruct(vertices, s.elements, s.frames, s.direct, kDirectSurface)
                                : std::vector<Rgb>(vertices.size(), Rgb(0));
  for_rows(vertices.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const uint32_t row = vertices.vertex_leaf[vertices.vertex_first[v]], face = s.elements.face[row];
      const auto& corner = vertices.leaf_vertex[row];
      const size_t k = static_cast<size_t>(std::find(corner.begin(), corner.end(), v) - corner.begin());
      const Vec2 uv =
          cell_corner_parameters(s.frames.triangle[face], s.elements.cell[row], s.elements.level[row])[k];
      const Rgb received =
          s.ambient + values[v] +
          sample_surface(s.patch_vertices, s.patches, s.frames, indirect, s.element_patch[row], uv);
      values[v] = faces.emission[face] + faces.reflectance[face] * received;
    }
  });
  return values;
}

}  // namespace

Rows get_rows(const Solution& s, const FaceTable& faces, const Tracer& tracer,
              const SolverSettings& settings) {
  return {s.hits,       s.patch_index, s.receivers, s.patches,
          faces,        s.frames,      tracer,      make_row_grid(count_row_rays(settings)),
          settings.seed};
}

// Mean over the exposed area of each patch of a column of its elements.
std::vector<Rgb> find_patch_means(const Solution& s, std::span<const Rgb> column) {
  std::vector<Rgb> means(s.patches.size(), Rgb(0));
  for_rows(means.size(), 256, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      Rgb sum(0);
      float area = 0;
      for (uint32_t row = s.element_first[p]; row < s.element_first[p + 1]; ++row) {
        const float exposed_area = s.elements.area[row] * s.elements.exposed[row];
        sum += exposed_area * column[row];
        area += exposed_area;
      }
      if (area > 0) means[p] = sum / area;
    }
  });
  return means;
}

std::vector<Rgb> vertex_radiosity(const Solution& s, const FaceTable& faces) {
  assert(s.frozen);
  return find_vertex_radiosity(s, faces, s.element_vertices, s.irradiance, !s.passes.empty());
}

std::vector<Rgb> vertex_radiosity_forecast(const Solution& s, const FaceTable& faces) {
  assert(s.frozen);
  return find_vertex_radiosity(s, faces, s.element_vertices, s.coarse, true);
}

std::vector<Rgb> element_irradiance(const Solution& s) {
  std::vector<Rgb> irradiance = s.passes.empty() ? std::vector<Rgb>(s.elements.size(), Rgb(0)) : s.direct;
  for_element_values(s, s.irradiance, all_rows(s.elements.size()),
                     [&](uint32_t row, Rgb received) { irradiance[row] += received; });
  return irradiance;
}

uint64_t find_solution_hash(const Solution& s) {
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, over 32-bit words
  for (const Rgb& value : s.elements.radiosity)
    for (int k = 0; k < 3; ++k) hash = (hash ^ std::bit_cast<uint32_t>(value[k])) * 0x100000001b3ull;
  return hash;
}

}  // namespace patchlight
