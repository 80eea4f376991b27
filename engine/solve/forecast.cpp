// Counts to seconds and bytes. The constants were fitted to rooms, a hall of 64 lamps and a furnished room of
// 8,508 faces, each with 64 to 1,024 rays a row and 20 thousand to 2 million patches, and looked at with
// 100,820 faces of furniture, on one core of an AMD EPYC.
#include "engine/solve/forecast.h"

#include "engine/factors/polygon_factors.h"
#include "engine/mesh/cell_rays.h"
#include "engine/solve/sizes.h"

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

// Microseconds. What a ray costs grows with the depth of the tree of faces, and faster where its levels no
// longer fit the caches.
constexpr double kRowRay = 0.065, kLampRay = 0.045, kPixel = 0.65;
constexpr double kRowRayOfDepth = 1.1e-4, kLampRayOfDepth = 4e-5, kPixelOfDepth = 4e-4;  // by its cube
constexpr double kKeptRay = 0.001;   // of a row that is kept, in each pass
constexpr double kElement = 1.5;     // split, compared and joined
constexpr double kAimedShare = 0.6;  // of what the rows cost: pass 2

constexpr double kSkyRaysOfRow = 800, kSkyRaysOfElement = 400;  // at cells of the sky

constexpr double kPatchesOfRooms = 24'000;  // beside one a face
// Of the square root of the scene's area: smaller faces of meshes share rows.
constexpr double kSharedSpan = 0.01;

// Bytes a row, from tables.h; with a face go what Embree and the loader keep of it.
template <typename Count>
Count sum_bytes(Count faces, Count patches, Count elements, Count kept_rays) {
  return 700 * faces + 200 * patches + 190 * elements + 8 * kept_rays;
}

uint64_t count_kept_rays_a_row(const SolverSettings& settings) {
  return settings.keep_rows ? make_ray_grid(count_row_rays(settings)).ray_count() : 0;
}

double cube_of_depth(const FaceTable& faces) {
  return std::pow(std::log2(static_cast<double>(faces.size()) + 1), 3);
}

struct Counts {
  double lamps = 0;        // faces that emit
  bool are_aimed = false;  // not where what emits is most of the scene: rows find it
  double rows = 0;         // that faces need, whole or in part
};
Counts count_faces(const FaceTable& faces) {
  const FaceFrameTable frames = make_face_frames(faces);
  double lit = 0, all = 0;
  for (uint32_t f = 0; f < faces.size(); ++f) all += double{cell_area(frames, f, 0, 0)};
  Counts counts;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const double area = double{cell_area(frames, f, 0, 0)};
    counts.rows += faces.surface[f] == kNone ? 1 : std::min(1.0, area / (all * kSharedSpan * kSharedSpan));
    if (largest(faces.emission[f]) <= 0) continue;
    lit += area;
    ++counts.lamps;
  }
  counts.are_aimed = counts.lamps > 0 && lit < all / 2;
  return counts;
}

// A mesh starts with so many elements. Shadow edges grow as the square root of their number, and what is
// smooth does not grow.
double forecast_elements(double start, double patches, const Counts& counts, const SolverSettings& settings) {
  constexpr double kAlongEdges = 800;
  const double refined = counts.are_aimed ? kAlongEdges * std::sqrt(start) : 0;
  const double most = std::max(start, static_cast<double>(settings.patch_count_max));
  return std::min(std::max(start, patches) + refined, most);
}

// Rays to lamps from all elements: fewer for each lamp where there are many.
double forecast_lamp_rays(double elements, const Counts& counts, double rays) {
  if (!counts.are_aimed) return 0;
  const double lamps = std::min(counts.lamps, 64.0);
  return elements * 110 * std::pow(lamps, 0.37) * std::pow(rays / 144, 0.4);
}

// The elements that a budget leads to, for solvers whose cost grows with all pairs of them.
uint64_t count_elements_most(const FaceTable& faces, const SolverSettings& settings,
                             uint64_t starting_patches) {
  return std::max({starting_patches, settings.patch_count_max, uint64_t{faces.size()}});
}

}  // namespace

Forecast forecast_solve(const FaceTable& faces, const SolverSettings& settings, uint64_t starting_patches,
                        const Sky& sky) {
  const auto face_count = static_cast<double>(faces.size());
  const auto start = static_cast<double>(starting_patches);
  const double budget = std::max(static_cast<double>(settings.patch_count_max), face_count);
  const double rays = make_ray_grid(count_row_rays(settings)).ray_count(), depth = cube_of_depth(faces);
  const double row_ray = kRowRay + kRowRayOfDepth * depth;
  Counts counts = count_faces(faces);
  if (!sky.is_dark()) counts.are_aimed = true;
  Forecast forecast;
  const double factor = find_size_factor(settings);
  const double more = std::min((budget - face_count) / 2, kPatchesOfRooms / (factor * factor));
  forecast.patches = face_count + more;
  forecast.rows = counts.rows + more;
  forecast.elements = forecast_elements(start, forecast.patches, counts, settings);
  const double row_rays = forecast.rows * rays;
  const double lamp_rays =
      forecast_lamp_rays(forecast.elements, counts, rays) +
      (sky.is_dark() ? 0 : kSkyRaysOfRow * forecast.rows + kSkyRaysOfElement * forecast.elements);
  const double later_passes = std::max(0.0, settings.pass_count_max - 2.0);
  forecast.rays = row_rays * (1 + kAimedShare) + lamp_rays;
  forecast.seconds = 1e-6 * (row_rays * row_ray * (1 + kAimedShare) +
                             lamp_rays * (kLampRay + kLampRayOfDepth * depth) + forecast.elements * kElement +
                             later_passes * row_rays * (settings.keep_rows ? kKeptRay : row_ray));
  forecast.bytes = sum_bytes<double>(face_count, forecast.patches, forecast.elements,
                                     forecast.rows * static_cast<double>(count_kept_rays_a_row(settings)));
  return forecast;
}

uint64_t forecast_matrix_bytes(const FaceTable& faces, const SolverSettings& settings,
                               uint64_t starting_patches) {
  const uint64_t n = count_elements_most(faces, settings, starting_patches);
  // Twenty times the square must not overflow.
  if (n >= uint64_t{1} << 29) return ~uint64_t{0} / 4;
  return n * n * sizeof(double) + forecast_factor_bytes(n, n);
}

double forecast_matrix_seconds(const FaceTable& faces, const SolverSettings& settings,
                               uint64_t starting_patches) {
  constexpr double kPair = 4e-6, kMultiply = 1.2e-10;
  const auto n = static_cast<double>(count_elements_most(faces, settings, starting_patches));
  return n * n * kPair + n * n * n * kMultiply;
}

double forecast_shooting_seconds(const FaceTable& faces, const SolverSettings& settings,
                                 uint64_t starting_patches) {
  constexpr double kShotsAPatch = 5, kShotElement = 1.5e-7;
  const Forecast mesh = forecast_solve(faces, settings, starting_patches);
  return kShotsAPatch * mesh.patches * mesh.elements * kShotElement;
}

double forecast_film_seconds(const FaceTable& faces, double pixels) {
  return 1e-6 * pixels * (kPixel + kPixelOfDepth * cube_of_depth(faces));
}

uint64_t forecast_bytes(const FaceTable& faces, const SolverSettings& settings, uint64_t starting_patches) {
  const uint64_t elements = std::max(starting_patches, settings.patch_count_max);
  const uint64_t patches = count_transport_patches(faces, settings);
  const uint64_t rays = count_kept_rays_a_row(settings) * patches;
  // The largest moment is a split, when the rows of the patches exist twice, or the making of the shared
  // corners of the elements.
  return std::max(sum_bytes<uint64_t>(faces.size(), patches, std::max(starting_patches, patches), 2 * rays),
                  sum_bytes<uint64_t>(faces.size(), patches, elements, rays));
}

}  // namespace patchlight
