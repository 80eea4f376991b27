// A solution to what is read of it: rows, means, radiosity at corners, irradiance, a hash.
#include "engine/solve/solution.h"

#include "engine/film/film.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace patchlight {
namespace {

// Radiosity at the corners of the elements, from irradiance: a column of the elements, one of the patches,
// and the same everywhere.
std::vector<Rgb> find_vertex_radiosity(const Solution& s, std::span<const Rgb> sharp,
                                       std::span<const Rgb> smooth, Rgb ambient) {
  const FaceTable& faces = s.surfaces->faces;
  const PatchTable& elements = s.mesh.elements;
  const VertexTable& vertices = s.mesh.element_vertices;
  const LeafSurface patches = patch_surface(s);
  const std::vector<Rgb> indirect = reconstruct(patches, smooth, kIndirectSurface);
  std::vector<Rgb> values = reconstruct({vertices, elements, s.surfaces->frames}, sharp, kDirectSurface);
  for_rows(vertices.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const uint32_t row = vertices.vertex_leaf[vertices.vertex_first[v]], face = elements.face[row];
      const auto& corner = vertices.leaf_vertex[row];
      const size_t k = static_cast<size_t>(std::find(corner.begin(), corner.end(), v) - corner.begin());
      const Vec2 uv = cell_corner_parameters(s.surfaces->frames.triangle[face], elements.cell[row],
                                             elements.level[row])[k];
      const Rgb received =
          ambient + values[v] + sample_surface(patches, indirect, s.mesh.element_patch[row], uv);
      values[v] = faces.emission[face] + faces.reflectance[face] * received;
    }
  });
  return values;
}

}  // namespace

Rows get_rows(const Solution& s) {
  return {{*s.surfaces, s.mesh.patches, s.mesh.patch_index, s.transport.receivers,
           make_ray_grid(count_row_rays(s.settings)), s.settings.seed},
          s.transport.hits};
}

DirectRays final_rays(const SolverSettings& settings) {
  const uint32_t rays = count_row_rays(settings);
  return {std::max(rays * 2 / 9, 16u), std::max(rays * 8 / 9, 16u), true};
}

std::vector<Rgb> find_sky_light(Solution& s) {
  const EmitterGroups& groups = s.transport.groups;
  if (groups.sky_group_count == 0) return {};
  if (groups.lamp_group_count() == 0) return s.light.direct;
  SightTable sights;
  sights.first.push_back(0);
  for (size_t r = 0; r + 1 < s.transport.sights.first.size(); ++r) {
    for (uint32_t k = s.transport.sights.first[r]; k < s.transport.sights.first[r + 1]; ++k) {
      if (!groups.is_sky(s.transport.sights.group[k])) continue;
      sights.group.push_back(s.transport.sights.group[k]);
      sights.pieces.push_back(s.transport.sights.pieces[k]);
      sights.clear.push_back(s.transport.sights.clear[k]);
    }
    sights.first.push_back(static_cast<uint32_t>(sights.group.size()));
  }
  std::vector<Rgb> light(s.mesh.elements.size());
  std::vector<float> error(light.size()), noise(light.size());
  s.log.direct_ray_count += find_direct({light, error, noise}, all_rows(light.size()),
                                        {*s.surfaces, s.mesh, s.transport.receivers, groups, sights},
                                        final_rays(s.settings), s.settings.seed);
  return light;
}

std::vector<Rgb> find_patch_means(const Solution& s, std::span<const Rgb> column) {
  std::vector<Rgb> means(s.mesh.patches.size(), Rgb(0));
  for_rows(means.size(), 256, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      Rgb sum(0);
      float area = 0;
      for (uint32_t row = s.mesh.element_first[p]; row < s.mesh.element_first[p + 1]; ++row) {
        const float exposed_area = s.mesh.elements.area[row] * s.mesh.elements.exposed[row];
        sum += exposed_area * column[row];
        area += exposed_area;
      }
      if (area > 0) means[p] = sum / area;
    }
  });
  return means;
}

std::vector<Rgb> vertex_radiosity(const Solution& s, Rgb ambient) {
  assert(s.mesh.frozen);
  const WorkersScope scope(s.workers);
  return find_vertex_radiosity(s, s.light.sharp, s.light.smooth, ambient);
}

std::vector<Rgb> vertex_radiosity_forecast(const Solution& s) {
  assert(s.mesh.frozen);
  const WorkersScope scope(s.workers);
  return find_vertex_radiosity(s, s.light.direct, s.light.coarse, Rgb(0));
}

Scenery make_scenery(const Solution& s) {
  const WorkersScope scope(s.workers);
  const FaceTable& faces = s.surfaces->faces;
  std::vector<float> brightness(s.mesh.elements.size());
  for_rows(brightness.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const uint32_t face = s.mesh.elements.face[row];
      const Rgb received = s.light.direct[row] + s.light.coarse[s.mesh.element_patch[row]];
      brightness[row] = largest(faces.emission[face] + faces.reflectance[face] * received);
    }
  });
  return {*s.surfaces, s.mesh, std::move(brightness), s.light.mean_radiosity};
}

std::vector<Rgb> element_irradiance(const Solution& s) {
  const WorkersScope scope(s.workers);
  std::vector<Rgb> irradiance = s.light.sharp;
  for_element_values(s, s.light.smooth, all_rows(s.mesh.elements.size()),
                     [&](uint32_t row, Rgb received) { irradiance[row] += received; });
  return irradiance;
}

uint64_t find_solution_hash(const Solution& s) {
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, over 32-bit words
  for (const Rgb& value : s.mesh.elements.radiosity)
    for (int k = 0; k < 3; ++k) hash = (hash ^ std::bit_cast<uint32_t>(value[k])) * 0x100000001b3ull;
  return hash;
}

uint64_t count_bytes(const Solution& s) {
  uint64_t bytes = 0;
  const auto add_column = [&](const char*, const auto& column) {
    bytes += column.capacity() * sizeof(column[0]);
  };
  const auto add = [&](const auto&... tables) { (for_each_column(add_column, tables), ...); };
  const auto add_columns = [&](const auto&... columns) { (add_column("", columns), ...); };
  if (s.surfaces) add(s.surfaces->frames, s.surfaces->links, s.surfaces->smooth_links);
  add(s.mesh.patches, s.mesh.elements, s.mesh.patch_vertices, s.mesh.element_vertices, s.transport.sights,
      s.transport.receivers, s.transport.hits);
  add_columns(s.mesh.patch_reach, s.mesh.element_first, s.mesh.element_patch, s.mesh.reasons, s.mesh.fresh,
              s.transport.emission_by_rows, s.light.sharp, s.light.smooth, s.light.smooth_added,
              s.light.smooth_error, s.transport.smoothing.leaf, s.transport.smoothing.first,
              s.transport.smoothing.neighbour, s.transport.smoothing.weight, s.light.direct,
              s.light.direct_error, s.light.direct_noise, s.light.coarse, s.light.coarse_error);
  return bytes;
}

}  // namespace patchlight
