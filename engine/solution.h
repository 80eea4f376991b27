// What the files that make, refine, advance and read a Solution share.
#pragma once

#include "parallel.h"
#include "polygon_factors.h"
#include "solve.h"
#include "vertices.h"

#include <chrono>
#include <numeric>

namespace patchlight {

// Direct light has edges: follow them closely. Indirect light is smooth and carries the noise of its rows:
// plain means between patches, which are small where it bends.
constexpr ReconstructSettings kDirectSurface{.sharpen_steps = 3, .border_steps = 3};
constexpr ReconstructSettings kIndirectSurface{.sharpen_steps = 0, .border_steps = 2};

class Stopwatch {
 public:
  // Seconds since it was made or last read.
  double read() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// How the settings size the mesh, in lengths: the longest edge of a starting patch, and of one that may still
// be split.
struct PatchSizes {
  float start, least;
};
PatchSizes find_patch_sizes(const FaceTable& faces, const FaceFrameTable& frames,
                            const SolverSettings& settings);
// How often a face is halved before the first round.
uint32_t find_start_level(const FaceTable& faces, const FaceFrameTable& frames, uint32_t face,
                          float patch_size);
// How many patches may carry light between surfaces.
uint64_t count_transport_patches(const FaceTable& faces, const SolverSettings& settings);

// Form factors between the elements, each a polygon of its own.
FactorTable find_element_factors(const Solution& solution, const FaceTable& faces, const Tracer& tracer,
                                 const SolverSettings& settings);

// Mean over the exposed area of each patch of a column of its elements.
std::vector<Rgb> find_patch_means(const Solution& solution, std::span<const Rgb> column);

// Writes what a step added into its report; added(row): the radiosity that it added to an element, W/m2.
template <typename Added>
void report_added(PassReport& report, const Solution& s, const Added& added) {
  for (size_t row = 0; row < s.elements.size(); ++row) {
    const Rgb radiosity = added(row);
    report.added_power += double{s.elements.area[row]} * s.elements.exposed[row] * DRgb(radiosity);
    report.added_largest = std::max(report.added_largest, largest(radiosity));
  }
}

// A column of the patches, as a surface, at the centres of the elements `rows` (a linear surface's mean over
// them).
template <typename Write>
void for_element_values(const Solution& s, std::span<const Rgb> patch_values, std::span<const uint32_t> rows,
                        const Write& write) {
  const std::vector<Rgb> surface =
      reconstruct(s.patch_vertices, s.patches, s.frames, patch_values, kIndirectSurface);
  for_rows(rows.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      const uint32_t row = rows[k], face = s.elements.face[row];
      const bool triangle = s.frames.triangle[face];
      const CellFrame cell = make_cell_frame(triangle, s.elements.cell[row], s.elements.level[row]);
      const Vec2 centre = cell.origin + Vec2(cell.size * (triangle ? 1 / 3.0f : 0.5f));
      write(row,
            sample_surface(s.patch_vertices, s.patches, s.frames, surface, s.element_patch[row], centre));
    }
  });
}

}  // namespace patchlight
