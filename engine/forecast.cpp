// Counts to seconds and bytes. The constants were fitted to five scenes (boxes, rooms, a hall of 64 lamps, a
// furnished room of 8,508 faces), each with 64 to 1,024 rays a row and 20 thousand to 2 million patches, on
// one core of an AMD EPYC of 2020.
#include "forecast.h"

#include "rows.h"
#include "solve.h"

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

constexpr double kFaceBytes = 400, kElementBytes = 190, kPatchBytes = 200, kRayBytes = 8;
constexpr double kPatchesOfRooms = 12'000;  // beside one a face

double cube_of_depth(const FaceTable& faces) {
  return std::pow(std::log2(static_cast<double>(faces.size()) + 1), 3);
}

// Faces that lamps are aimed from and their number; none where what emits is most of the scene: rows find it.
struct Lamps {
  double count = 0;
  bool aimed = false;
};
Lamps find_lamps(const FaceTable& faces) {
  const FaceFrameTable frames = make_face_frames(faces);
  double lit = 0, all = 0;
  Lamps lamps;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const double area = double{cell_area(frames, f, 0, 0)};
    all += area;
    if (largest(faces.emission[f]) <= 0) continue;
    lit += area;
    ++lamps.count;
  }
  lamps.aimed = lamps.count > 0 && lit < all / 2;
  return lamps;
}

// A mesh starts with so many elements. Shadow edges grow as the square root of their number, and what is
// smooth does not grow.
double forecast_elements(double start, double patches, const Lamps& lamps, const SolverSettings& settings) {
  constexpr double kAlongEdges = 800;
  const double refined = lamps.aimed ? kAlongEdges * std::sqrt(start) : 0;
  const double most = std::max(start, static_cast<double>(settings.patch_count_max));
  return std::min(std::max(start, patches) + refined, most);
}

// Rays to lamps from all elements: fewer for each lamp where there are many.
double forecast_lamp_rays(double elements, const Lamps& lamps, double rays) {
  if (!lamps.aimed) return 0;
  const double count = std::min(lamps.count, static_cast<double>(kAimedLampsMax));
  return elements * 110 * std::pow(count, 0.37) * std::pow(rays / 256, 0.4);
}

}  // namespace

Forecast forecast_solve(const FaceTable& faces, const SolverSettings& settings) {
  const auto face_count = static_cast<double>(faces.size());
  const auto start = static_cast<double>(count_starting_patches(faces, settings));
  const double budget = std::max(static_cast<double>(settings.patch_count_max), face_count);
  const double rays = make_row_grid(count_row_rays(settings)).ray_count(), depth = cube_of_depth(faces);
  const double row_ray = kRowRay + kRowRayOfDepth * depth;
  const Lamps lamps = find_lamps(faces);
  Forecast forecast;
  const double factor = find_size_factor(settings);
  forecast.patches = face_count + std::min((budget - face_count) / 2, kPatchesOfRooms / (factor * factor));
  forecast.elements = forecast_elements(start, forecast.patches, lamps, settings);
  const double row_rays = forecast.patches * rays;
  const double lamp_rays = forecast_lamp_rays(forecast.elements, lamps, rays);
  const double later_passes = std::max(0.0, settings.pass_count_max - 2.0);
  forecast.rays = row_rays * (1 + kAimedShare) + lamp_rays;
  forecast.seconds = 1e-6 * (row_rays * row_ray * (1 + kAimedShare) +
                             lamp_rays * (kLampRay + kLampRayOfDepth * depth) + forecast.elements * kElement +
                             later_passes * row_rays * (settings.keep_rows ? kKeptRay : row_ray));
  forecast.bytes = face_count * kFaceBytes + forecast.elements * kElementBytes +
                   forecast.patches * (kPatchBytes + (settings.keep_rows ? rays * kRayBytes : 0));
  return forecast;
}

double forecast_film_seconds(const FaceTable& faces, double pixels) {
  return 1e-6 * pixels * (kPixel + kPixelOfDepth * cube_of_depth(faces));
}

}  // namespace patchlight
