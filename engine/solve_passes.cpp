// The default solver: pass by pass.
//
// B after pass k is the sum over m = 0..k of (rho F)^m E: B starts as E, and every pass adds what the patches
// receive of the radiosity that the pass before added (Goral, Torrance, Greenberg, Battaile: Modeling the
// Interaction of Light Between Diffuse Surfaces, 1984; the Neumann series of Kajiya: The Rendering Equation,
// 1986).
#include "gather.h"
#include "solution.h"
#include "sources.h"

#include <algorithm>

namespace patchlight {
namespace {

constexpr uint32_t kSourceCount = 400;

// The rays of all rows, and a factor for each element and lamp aimed at.
uint64_t count_factors(const Solution& s, const FaceTable& faces) {
  uint64_t count = uint64_t{s.hits.ray_count} * s.receivers.size();
  for (uint32_t face = 0; face < faces.size(); ++face) {
    const uint64_t elements = s.elements.face_first[face + 1] - s.elements.face_first[face];
    const uint32_t list = s.aims.list_of[faces.polygon[face]];
    count += elements * (s.aims.list_first[list + 1] - s.aims.list_first[list]);
  }
  return count;
}

}  // namespace

const PassReport& advance(Solution& s, const FaceTable& faces, const Tracer& tracer,
                          const SolverSettings& settings) {
  Stopwatch watch;
  if (!s.frozen) freeze(s, faces, tracer, settings);
  const Rows rows = get_rows(s, faces, tracer, settings);
  PassReport report;
  report.pass = static_cast<uint32_t>(s.passes.size()) + 1;
  if (report.pass == 1) {
    gather_emission(s.irradiance_added, rows, s.aims);
    report.ray_count = s.direct_ray_count;
    s.factor_count += count_factors(s, faces);
  } else if (report.pass == 2) {
    const SourceTable sources = make_sources(s.elements, faces, s.frames, s.elements.unshot, kSourceCount);
    const uint64_t aimed =
        gather_elements(s.irradiance_added, rows, {s.elements, s.element_first}, s.elements.unshot, sources);
    s.transport_ray_count += aimed;
    s.factor_count += aimed;
    report.ray_count = aimed + uint64_t{s.hits.ray_count} * s.receivers.size();
  } else {
    const std::vector<Rgb> sent = s.patches.unshot;
    gather_patches(s.irradiance_added, {}, rows, sent);
  }
  for (size_t p = 0; p < s.patches.size(); ++p) {
    s.irradiance[p] += s.irradiance_added[p];
    s.patches.unshot[p] = faces.reflectance[s.patches.face[p]] * s.irradiance_added[p];
    s.patches.radiosity[p] += s.patches.unshot[p];
  }
  for_element_values(s, s.irradiance_added, all_rows(s.elements.size()), [&](uint32_t row, Rgb received) {
    if (report.pass == 1) received += s.direct[row];
    s.elements.unshot[row] = faces.reflectance[s.elements.face[row]] * received;
    s.elements.radiosity[row] += s.elements.unshot[row];
  });
  if (report.pass == 1) {
    s.patches.unshot = find_patch_means(s, s.elements.unshot);
    s.patches.radiosity = find_patch_means(s, s.elements.radiosity);
  }
  report_added(report, s, [&](size_t row) { return s.elements.unshot[row]; });
  report.unshot_power = report.added_power;  // the next pass sends it
  report.seconds = watch.read();
  s.seconds.solve += report.seconds;
  return s.passes.emplace_back(report);
}

bool is_converged(const Solution& s, const SolverSettings& settings) {
  if (s.passes.empty()) return false;
  const PassReport &first = s.passes.front(), &last = s.passes.back();
  if (last.added_largest == 0) return true;
  return static_cast<double>(last.added_largest) <
             settings.until * static_cast<double>(first.added_largest) &&
         sum_channels(last.added_power) < settings.until * sum_channels(first.added_power);
}

}  // namespace patchlight
