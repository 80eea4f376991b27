// What the files that make, refine, advance and read a Solution share.
#pragma once

#include "engine/base/parallel.h"
#include "engine/base/stopwatch.h"
#include "engine/light/direct.h"
#include "engine/mesh/vertices.h"
#include "engine/solve/solve.h"
#include "engine/transport/rows.h"

namespace patchlight {

// Direct light has edges: follow them closely. Indirect light is smooth and carries the noise of its rows:
// plain means between patches, which are small where it bends.
constexpr ReconstructSettings kDirectSurface{.sharpen_steps = 3, .border_steps = 3};
constexpr ReconstructSettings kIndirectSurface{.sharpen_steps = 0, .border_steps = 2};

// Of a normal error the mean absolute value is this share of the standard deviation.
constexpr double kMeanOfError = 0.8;

// The rows of the patches, for kernels that gather.
Rows get_rows(const Solution& solution);

// Rays for the direct light of an element of the final mesh.
DirectRays final_rays(const SolverSettings& settings);

// Irradiance of each element from the sky and the sun alone, W/m2; empty where they are dark. Raises the
// log's count of rays where they were not cast before.
std::vector<Rgb> find_sky_light(Solution& solution);

// The patches as a surface.
inline LeafSurface patch_surface(const Solution& s) {
  return {s.mesh.patch_vertices, s.mesh.patches, s.surfaces->frames};
}

// Mean over the exposed area of each patch of a column of its elements.
std::vector<Rgb> find_patch_means(const Solution& solution, std::span<const Rgb> column);

// Writes what a step added into its report; added(row): the radiosity that it added to an element, W/m2.
template <typename Added>
void report_added(PassReport& report, const Solution& s, const Added& added) {
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    const Rgb radiosity = added(row);
    report.added_power += double{s.mesh.elements.area[row]} * s.mesh.elements.exposed[row] * DRgb(radiosity);
    report.added_largest = std::max(report.added_largest, largest(radiosity));
  }
}

// A column of the patches, as a surface, at the centres of the elements `rows` (a linear surface's mean over
// them).
template <typename Write>
void for_element_values(const Solution& s, std::span<const Rgb> patch_values, std::span<const uint32_t> rows,
                        const Write& write) {
  const LeafSurface patches = patch_surface(s);
  const std::vector<Rgb> surface = reconstruct(patches, patch_values, kIndirectSurface);
  for_rows(rows.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      const uint32_t row = rows[k], face = s.mesh.elements.face[row];
      const bool triangle = s.surfaces->frames.triangle[face];
      const CellFrame cell = make_cell_frame(triangle, s.mesh.elements.cell[row], s.mesh.elements.level[row]);
      const Vec2 centre = cell.origin + Vec2(cell.size * (triangle ? 1 / 3.0f : 0.5f));
      write(row, sample_surface(patches, surface, s.mesh.element_patch[row], centre));
    }
  });
}

}  // namespace patchlight
