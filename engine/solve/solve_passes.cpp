// The default solver: pass by pass.
//
// B after pass k is the sum over m = 0..k of (rho F)^m E: B starts as E, and every pass adds what the patches
// receive of the radiosity that the pass before added (Goral, Torrance, Greenberg, Battaile: Modeling the
// Interaction of Light Between Diffuse Surfaces, 1984; the Neumann series of Kajiya: The Rendering Equation,
// 1986).
#include "engine/solve/solution.h"
#include "engine/transport/gather.h"
#include "engine/transport/sources.h"

namespace patchlight {
namespace {

constexpr uint32_t kSourceCount = 400;

// The rays of all rows, and a factor for each element and group of emitters that it may see.
uint64_t count_factors(const Solution& s) {
  uint64_t count = uint64_t{s.transport.hits.ray_count} * s.transport.receivers.size();
  for (const uint32_t patch : s.mesh.element_patch) {
    const uint32_t receiver = s.transport.receivers.receiver_of[patch];
    count += s.transport.sights.first[receiver + 1] - s.transport.sights.first[receiver];
  }
  return count;
}

}  // namespace

const PassReport& advance(Solution& s) {
  const WorkersScope scope(s.workers);
  Stopwatch watch;
  if (!s.mesh.frozen) freeze(s);
  const FaceTable& faces = s.surfaces->faces;
  const Rows rows = get_rows(s);
  PassReport report;
  report.pass = static_cast<uint32_t>(s.log.passes.size()) + 1;
  if (report.pass == 1) {
    s.light.sharp = s.light.direct;
    gather_emission(s.light.smooth_added, rows, s.transport.aiming);
    report.ray_count = s.log.direct_ray_count;
    s.log.factor_count += count_factors(s);
  } else if (report.pass == 2) {
    const SourceTable sources =
        make_sources(s.mesh.elements, *s.surfaces, s.mesh.elements.unshot, kSourceCount);
    const uint64_t aimed = gather_elements(
        s.light.smooth_added, rows, {s.mesh.elements, s.mesh.element_first}, s.mesh.elements.unshot, sources);
    s.log.transport_ray_count += aimed;
    s.log.factor_count += aimed;
    report.ray_count = aimed + uint64_t{s.transport.hits.ray_count} * s.transport.receivers.size();
  } else {
    const std::vector<Rgb> sent = s.mesh.patches.unshot;
    gather_patches(s.light.smooth_added, {}, rows, sent);
  }
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    s.light.smooth[p] += s.light.smooth_added[p];
    s.mesh.patches.unshot[p] = faces.reflectance[s.mesh.patches.face[p]] * s.light.smooth_added[p];
    s.mesh.patches.radiosity[p] += s.mesh.patches.unshot[p];
  }
  for_element_values(s, s.light.smooth_added, all_rows(s.mesh.elements.size()),
                     [&](uint32_t row, Rgb received) {
                       if (report.pass == 1) received += s.light.direct[row];
                       s.mesh.elements.unshot[row] = faces.reflectance[s.mesh.elements.face[row]] * received;
                       s.mesh.elements.radiosity[row] += s.mesh.elements.unshot[row];
                     });
  if (report.pass == 1) {
    s.mesh.patches.unshot = find_patch_means(s, s.mesh.elements.unshot);
    s.mesh.patches.radiosity = find_patch_means(s, s.mesh.elements.radiosity);
  }
  report_added(report, s, [&](size_t row) { return s.mesh.elements.unshot[row]; });
  report.unshot_power = report.added_power;  // the next pass sends it
  report.seconds = watch.lap();
  s.log.solve_seconds += report.seconds;
  return s.log.passes.emplace_back(report);
}

bool is_converged(const Solution& s) {
  const double until = s.settings.until;
  if (s.log.passes.empty()) return false;
  const PassReport &first = s.log.passes.front(), &last = s.log.passes.back();
  if (last.added_largest == 0) return true;
  return static_cast<double>(last.added_largest) < until * static_cast<double>(first.added_largest) &&
         sum_channels(last.added_power) < until * sum_channels(first.added_power);
}

}  // namespace patchlight
