// The solver `shooting`: classical progressive refinement. The patch with the most unshot power sends it to
// all elements, again and again, until little is left (Cohen, Chen, Wallace, Greenberg: A Progressive
// Refinement Approach to Fast Radiosity Image Generation, 1988). It ends at the same B as the passes do, by
// another way: after few shots the picture is not one of so many bounces, but it is lit.
#include "shoot.h"
#include "solution.h"

#include <algorithm>
#include <cassert>

namespace patchlight {
namespace {

// Of the scene's mean radiosity: a shot that brings an element less casts one ray from it.
constexpr float kBrightShot = 0.01f;

DRgb find_unshot_power(const Solution& s, size_t patch) {
  return double{s.patches.area[patch]} * s.patches.exposed[patch] * DRgb(s.patches.unshot[patch]);
}

// The first of the patches with the most unshot power.
uint32_t pick_shooter(const Solution& s) {
  uint32_t best = 0;
  double most = -1;
  for (uint32_t p = 0; p < s.patches.size(); ++p)
    if (const double power = sum_channels(find_unshot_power(s, p)); power > most) most = power, best = p;
  return best;
}

// Nothing has been sent yet: the elements have no light, direct light neither, and all patches hold E.
void start_shooting(Solution& s) {
  std::fill(s.direct.begin(), s.direct.end(), Rgb(0));
  s.shots.assign(s.patches.size(), 0);
}

// What the elements received is theirs to send on.
void receive_shot(Solution& s, std::span<const Rgb> irradiance, const FaceTable& faces) {
  for_rows(s.patches.size(), 64, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      const Rgb reflectance = faces.reflectance[s.patches.face[p]];
      Rgb sum(0);
      float exposed_area = 0;
      for (uint32_t row = s.element_first[p]; row < s.element_first[p + 1]; ++row) {
        const Rgb added = reflectance * irradiance[row];
        const float area = s.elements.area[row] * s.elements.exposed[row];
        s.direct[row] += irradiance[row];
        s.elements.radiosity[row] += added;
        s.elements.unshot[row] += added;
        sum += area * added;
        exposed_area += area;
      }
      if (exposed_area == 0) continue;
      s.patches.radiosity[p] += sum / exposed_area;
      s.patches.unshot[p] += sum / exposed_area;
    }
  });
}

// The light that is still unshot, spread evenly over all surfaces and reflected without end: an estimate for
// pictures, which no shot uses (section 4.2 of the paper).
Rgb find_ambient(const Solution& s, const FaceTable& faces) {
  DRgb unshot(0), reflected(0);
  double area = 0;
  for (size_t p = 0; p < s.patches.size(); ++p) {
    const double exposed_area = double{s.patches.area[p]} * s.patches.exposed[p];
    // A lamp that has not been shot would light everything: what it sends may miss the scene, as the sun's
    // does.
    if (s.shots[p] > 0 || largest(faces.emission[s.patches.face[p]]) == 0) unshot += find_unshot_power(s, p);
    reflected += exposed_area * DRgb(faces.reflectance[s.patches.face[p]]);
    area += exposed_area;
  }
  Rgb ambient(0);
  for (int k = 0; k < 3; ++k)
    if (area > reflected[k]) ambient[k] = static_cast<float>(unshot[k] / (area - reflected[k]));
  return ambient;
}

}  // namespace

const PassReport& advance_shot(Solution& s, const FaceTable& faces, const Tracer& tracer,
                               const SolverSettings& settings) {
  Stopwatch watch;
  if (!s.frozen) freeze(s, faces, tracer, settings);
  if (s.passes.empty()) start_shooting(s);
  const uint32_t shooter = pick_shooter(s);
  const Lamp lamp =
      make_lamp(faces, s.frames, s.patches.face[shooter], s.patches.cell[shooter], s.patches.level[shooter]);
  const Rgb sent = s.patches.unshot[shooter];
  s.patches.unshot[shooter] = Rgb(0);
  for (uint32_t row = s.element_first[shooter]; row < s.element_first[shooter + 1]; ++row)
    s.elements.unshot[row] = Rgb(0);

  PassReport report;
  report.pass = static_cast<uint32_t>(s.passes.size()) + 1;
  std::vector<Rgb> irradiance(s.elements.size());
  const ShotCounts counts = shoot(irradiance, s.elements, lamp, sent, faces, s.frames, tracer,
                                  {.bright = kBrightShot * s.mean_radiosity}, settings.seed, s.passes.size());
  receive_shot(s, irradiance, faces);
  ++s.shots[shooter];

  s.factor_count += counts.factors;
  s.transport_ray_count += counts.rays;
  report.ray_count = counts.rays;
  report_added(report, s,
               [&](size_t row) { return faces.reflectance[s.elements.face[row]] * irradiance[row]; });
  for (size_t p = 0; p < s.patches.size(); ++p) report.unshot_power += find_unshot_power(s, p);
  s.shot_power += sum_channels(report.added_power);
  s.ambient = settings.ambient ? find_ambient(s, faces) : Rgb(0);
  report.seconds = watch.read();
  s.seconds.solve += report.seconds;
  return s.passes.emplace_back(report);
}

bool is_shot(const Solution& s, const SolverSettings& settings) {
  if (s.passes.empty()) return false;
  const double unshot = sum_channels(s.passes.back().unshot_power);
  return unshot == 0 || (s.shot_power > 0 && unshot < settings.until * s.shot_power);
}

}  // namespace patchlight
