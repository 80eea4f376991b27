// The solver `shooting`: classical progressive refinement. The patch with the most unshot power sends it to
// all elements, again and again, until little is left (Cohen, Chen, Wallace, Greenberg: A Progressive
// Refinement Approach to Fast Radiosity Image Generation, 1988). It ends at the same B as the passes do, by
// another way: after few shots the picture is not one of so many bounces, but it is lit.
#include "engine/solve/solve_shooting.h"

#include "engine/light/shoot.h"
#include "engine/solve/solution.h"

#include <algorithm>

namespace patchlight {
namespace {

// Of the scene's mean radiosity: a shot that brings an element less casts one ray from it.
constexpr float kBrightShot = 0.01f;

DRgb find_unshot_power(const Solution& s, size_t patch) {
  return double{s.mesh.patches.area[patch]} * s.mesh.patches.exposed[patch] *
         DRgb(s.mesh.patches.unshot[patch]);
}

// The first of the patches with the most unshot power.
uint32_t pick_shooter(const Solution& s) {
  uint32_t best = 0;
  double most = -1;
  for (uint32_t p = 0; p < s.mesh.patches.size(); ++p)
    if (const double power = sum_channels(find_unshot_power(s, p)); power > most) most = power, best = p;
  return best;
}

// What a unit of unshot power still adds by all later reflections, at the scene's mean reflectance, if
// nothing leaves: among bright walls that is many times itself. At least 1, so that dark rooms end as late as
// ever.
double find_rebound(const Solution& s) {
  constexpr double kMost = 1e4;
  DRgb reflected(0);
  double area = 0;
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    const double exposed_area = double{s.mesh.patches.area[p]} * s.mesh.patches.exposed[p];
    reflected += exposed_area * DRgb(s.surfaces->faces.reflectance[s.mesh.patches.face[p]]);
    area += exposed_area;
  }
  if (area <= 0) return 1;
  const double mean = std::max({reflected.r, reflected.g, reflected.b}) / area;
  return std::clamp(mean / std::max(1 - mean, 1e-9), 1.0, kMost);
}

// What the elements received is theirs to send on.
void receive_shot(Solution& s, std::span<const Rgb> irradiance) {
  for_rows(s.mesh.patches.size(), 64, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      const Rgb reflectance = s.surfaces->faces.reflectance[s.mesh.patches.face[p]];
      Rgb sum(0);
      float exposed_area = 0;
      for (uint32_t row = s.mesh.element_first[p]; row < s.mesh.element_first[p + 1]; ++row) {
        const Rgb added = reflectance * irradiance[row];
        const float area = s.mesh.elements.area[row] * s.mesh.elements.exposed[row];
        s.light.sharp[row] += irradiance[row];
        s.mesh.elements.radiosity[row] += added;
        s.mesh.elements.unshot[row] += added;
        sum += area * added;
        exposed_area += area;
      }
      if (exposed_area == 0) continue;
      s.mesh.patches.radiosity[p] += sum / exposed_area;
      s.mesh.patches.unshot[p] += sum / exposed_area;
    }
  });
}

// What is there once the elements have received: added to the log.
const PassReport& finish_shot(Solution& s, PassReport report, std::span<const Rgb> irradiance,
                              Stopwatch watch) {
  const FaceTable& faces = s.surfaces->faces;
  report_added(report, s,
               [&](size_t row) { return faces.reflectance[s.mesh.elements.face[row]] * irradiance[row]; });
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) report.unshot_power += find_unshot_power(s, p);
  s.shooting->power += sum_channels(report.added_power);
  report.seconds = watch.lap();
  s.log.solve_seconds += report.seconds;
  return s.log.passes.emplace_back(report);
}

}  // namespace

const PassReport& advance_shot(Solution& s) {
  const WorkersScope scope(s.workers);
  Stopwatch watch;
  if (!s.mesh.frozen) freeze(s);
  const bool is_first = !s.shooting;
  if (is_first) s.shooting = {std::vector<uint32_t>(s.mesh.patches.size(), 0)};
  const FaceTable& faces = s.surfaces->faces;
  PassReport report;
  report.pass = static_cast<uint32_t>(s.log.passes.size()) + 1;
  // The first shot is that of the sky.
  if (is_first && !s.surfaces->sky.is_dark()) {
    const uint64_t rays_before = s.log.direct_ray_count;
    const std::vector<Rgb> light = find_sky_light(s);
    receive_shot(s, light);
    s.log.factor_count += light.size() * s.transport.groups.sky_group_count;
    report.ray_count = s.log.direct_ray_count - rays_before;
    return finish_shot(s, report, light, watch);
  }
  const uint32_t shooter = pick_shooter(s);
  const Shot shot{make_emitter(faces, s.surfaces->frames, name_cell(s.mesh.patches, shooter)),
                  s.mesh.patches.unshot[shooter], s.log.passes.size(), s.settings.seed};
  s.mesh.patches.unshot[shooter] = Rgb(0);
  for (uint32_t row = s.mesh.element_first[shooter]; row < s.mesh.element_first[shooter + 1]; ++row)
    s.mesh.elements.unshot[row] = Rgb(0);

  std::vector<Rgb> irradiance(s.mesh.elements.size());
  const ShotCounts counts =
      shoot(irradiance, shot, s.mesh.elements, *s.surfaces, {.bright = kBrightShot * s.light.mean_radiosity});
  receive_shot(s, irradiance);
  ++s.shooting->shots[shooter];

  s.log.factor_count += counts.factors;
  s.log.transport_ray_count += counts.rays;
  report.ray_count = counts.rays;
  return finish_shot(s, report, irradiance, watch);
}

bool is_shot(const Solution& s) {
  if (s.log.passes.empty()) return false;
  const double unshot = sum_channels(s.log.passes.back().unshot_power);
  return unshot == 0 ||
         (s.shooting->power > 0 && unshot * find_rebound(s) < s.settings.until * s.shooting->power);
}

// The light that is still unshot, spread evenly over all surfaces and reflected without end: an estimate for
// pictures, which no shot uses (section 4.2 of the paper).
Rgb find_ambient(const Solution& s) {
  if (!s.shooting) return Rgb(0);
  const FaceTable& faces = s.surfaces->faces;
  DRgb unshot(0), reflected(0);
  double area = 0;
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    const double exposed_area = double{s.mesh.patches.area[p]} * s.mesh.patches.exposed[p];
    // A lamp that has not been shot would light everything: what it sends may miss the scene, as the sun's
    // does.
    if (s.shooting->shots[p] > 0 || largest(faces.emission[s.mesh.patches.face[p]]) == 0)
      unshot += find_unshot_power(s, p);
    reflected += exposed_area * DRgb(faces.reflectance[s.mesh.patches.face[p]]);
    area += exposed_area;
  }
  Rgb ambient(0);
  for (int k = 0; k < 3; ++k)
    if (area > reflected[k]) ambient[k] = static_cast<float>(unshot[k] / (area - reflected[k]));
  return ambient;
}

}  // namespace patchlight
