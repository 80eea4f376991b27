// The default solver: pass by pass.
//
// B after pass k is the sum over m = 0..k of (rho F)^m E: B starts as E, and every pass adds what the patches
// receive of the radiosity that the pass before added (Goral, Torrance, Greenberg, Battaile: Modeling the
// Interaction of Light Between Diffuse Surfaces, 1984; the Neumann series of Kajiya: The Rendering Equation,
// 1986).
#include "engine/solve/solution.h"
#include "engine/transport/gather.h"
#include "engine/transport/smoothing.h"
#include "engine/transport/sources.h"

#include <algorithm>

namespace patchlight {
namespace {

constexpr uint32_t kSourceCount = 400;

// What patches receive is smoothed by 32 steps at most (smoothing.h).
constexpr uint32_t kBounceStrengths = 7;
// Of the error asked for, what noise of bounced light may take.
constexpr double kRowsOfError = 0.5, kLaterOfError = 0.15;
// And what noise of a late bounce may take unsmoothed.
constexpr double kQuietOfError = 0.02;
// Where there is less than this share of the scene's mean light, errors are shares of that.
constexpr double kDark = 0.1;
// Where more rays are asked for, so many times as many as a row has; so often at most; over all receivers not
// more than so many times the rows' rays.
constexpr uint32_t kMoreRays = 4, kMoreRounds = 3, kMoreRaysMax = 8;

// The rays of all rows, and a factor for each element and group of emitters that it may see.
uint64_t count_factors(const Solution& s) {
  uint64_t count = uint64_t{s.transport.hits.ray_count} * s.transport.receivers.size();
  for (const uint32_t patch : s.mesh.element_patch) {
    const uint32_t receiver = s.transport.receivers.receiver_of[patch];
    count += s.transport.sights.first[receiver + 1] - s.transport.sights.first[receiver];
  }
  return count;
}

// What an error of a patch counts for: a picture may be of any corner, and is exposed for what it shows, so
// that errors are shares of the light that is around. weight: a row a patch, 1 / (W/m2) times lengths
// squared; of an error of the share x everywhere the weighted sum is x times `all`.
struct ErrorWeights {
  std::vector<double> weight;
  double all = 0;
};
ErrorWeights find_error_weights(const Solution& s) {
  const size_t count = s.mesh.patches.size();
  const std::vector<Rgb> direct = find_patch_means(s, s.light.direct);
  std::vector<double> shown(count), light(count);  // lengths squared; W/m2
  double shown_sum = 0, light_sum = 0;
  for (size_t p = 0; p < count; ++p) {
    shown[p] = double{s.mesh.patches.area[p]} * s.mesh.patches.exposed[p] *
               luminance(s.surfaces->faces.reflectance[s.mesh.patches.face[p]]);
    light[p] = luminance(direct[p] + s.light.coarse[p]);
    shown_sum += shown[p], light_sum += shown[p] * light[p];
  }
  ErrorWeights weights{std::vector<double>(count, 0), 0};
  if (light_sum == 0) return weights;
  const double dark = kDark * light_sum / shown_sum;
  for (size_t p = 0; p < count; ++p) {
    weights.weight[p] = shown[p] / (light[p] + dark);
    weights.all += weights.weight[p] * light[p];
  }
  return weights;
}

// The errors of a receiver's patches, weighed.
std::vector<double> find_error_power(const Solution& s, const ErrorWeights& weights,
                                     std::span<const float> error) {
  std::vector<double> power(s.transport.receivers.size(), 0);
  for (size_t p = 0; p < error.size(); ++p)
    power[s.transport.receivers.receiver_of[p]] += kMeanOfError * weights.weight[p] * error[p];
  return power;
}

double sum_error_power(const Solution& s, const ErrorWeights& weights, std::span<const float> error) {
  double sum = 0;
  for (const double power : find_error_power(s, weights, error)) sum += power;
  return sum;
}

// Which receivers need more rays so that their errors' sum falls to `target`: those with the largest, for a
// ray helps most there. gain: the share of an error that more rays take away.
std::vector<uint8_t> pick_noisy(std::span<const double> error_power, double target, double gain,
                                size_t count_max) {
  double sum = 0;
  for (const double power : error_power) sum += power;
  std::vector<uint32_t> order = all_rows(error_power.size());
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return error_power[a] > error_power[b]; });
  std::vector<uint8_t> asked(error_power.size(), 0);
  for (size_t k = 0; k < std::min(order.size(), count_max) && sum > target; ++k) {
    asked[order[k]] = 1;
    sum -= gain * error_power[order[k]];
  }
  return asked;
}

// What patches receive of a bounce, smoothed, W/m2, and the error that is left.
struct SmoothBounce {
  std::vector<Rgb> received;
  std::vector<float> error;
};
SmoothBounce smooth_bounce(const Solution& s, const std::vector<Rgb>& received,
                           std::span<const Rgb> difference) {
  SmoothBounce bounce{received, std::vector<float>(received.size())};
  std::vector<float> noise(received.size());
  for (size_t p = 0; p < noise.size(); ++p) noise[p] = mean_channel(difference[p]);
  smooth_noise({bounce.received, noise, bounce.error}, s.transport.smoothing, kBounceStrengths);
  keep_power(bounce.received, received, s.transport.smoothing, s.mesh.patches, s.surfaces->faces);
  return bounce;
}

// What patches receive of light that bright places make noisy: with the rays of the rows and aimed ones, then
// with more where their noise is more than the error asked for leaves to it. ray_count: raised by all but the
// rows'.
SmoothBounce gather_aimed(const Solution& s, uint64_t& ray_count) {
  const Rows rows = get_rows(s);
  const Elements elements{s.mesh.elements, s.mesh.element_first};
  const std::span<const Rgb> sent = s.mesh.elements.unshot;
  const SourceTable sources = make_sources(s.mesh.elements, *s.surfaces, sent, kSourceCount);
  std::vector<Rgb> received(s.mesh.patches.size()), noise(received.size());
  ray_count += gather_elements(received, noise, rows, elements, sent, sources);
  SmoothBounce bounce = smooth_bounce(s, received, noise);
  const size_t count = s.transport.receivers.size(), patch_count = received.size();
  const ErrorWeights weights = find_error_weights(s);
  const double target = kRowsOfError * s.settings.error * weights.all;
  size_t rows_left = kMoreRaysMax * count / kMoreRays;
  std::vector<float> rays_of(count, 1);  // so many times those of a row
  for (uint64_t round = 1; round <= kMoreRounds; ++round) {
    const double gain = 1 - std::sqrt(1.0 / (1 + kMoreRays));
    const std::vector<uint8_t> asked =
        pick_noisy(find_error_power(s, weights, bounce.error), target, gain, rows_left);
    const auto asked_count = static_cast<size_t>(std::count(asked.begin(), asked.end(), 1));
    if (asked_count == 0) break;
    rows_left -= asked_count;
    // Rows of other rays, and more of them, which nothing keeps.
    HitTable again;
    again.ray_count = kMoreRays * s.transport.hits.ray_count;
    for (const uint32_t buried : s.transport.hits.buried) again.buried.push_back(kMoreRays * buried);
    Casters by = rows.by;
    by.grid = make_ray_grid(again.ray_count);
    by.seed = mix_bits(s.settings.seed + (round << 32));
    again.ray_count = by.grid.ray_count();
    std::vector<Rgb> more(patch_count), more_noise(patch_count);
    ray_count += gather_elements(more, more_noise, {by, again}, elements, sent, sources, asked) +
                 uint64_t{again.ray_count} * asked_count;
    for (size_t p = 0; p < patch_count; ++p) {
      const uint32_t receiver = s.transport.receivers.receiver_of[p];
      if (!asked[receiver]) continue;
      const float share = kMoreRays / (kMoreRays + rays_of[receiver]);
      received[p] = received[p] + share * (more[p] - received[p]);
      noise[p] = noise[p] + share * (more_noise[p] - noise[p]);
    }
    for (size_t row = 0; row < count; ++row)
      if (asked[row]) rays_of[row] += kMoreRays;
    bounce = smooth_bounce(s, received, noise);
  }
  return bounce;
}

// The first pass: emission that rows meet.
SmoothBounce gather_first(const Solution& s) {
  std::vector<Rgb> received(s.mesh.patches.size()), noise(received.size());
  gather_emission(received, noise, get_rows(s), s.transport.emission_by_rows);
  return smooth_bounce(s, received, noise);
}

// The third pass and later ones: the rows' own rays; where light is still so uneven that they are too noisy,
// it is aimed at once more.
SmoothBounce gather_later(const Solution& s, uint64_t& ray_count) {
  std::vector<Rgb> received(s.mesh.patches.size()), noise(received.size());
  gather_patches(received, noise, get_rows(s), s.mesh.patches.unshot);
  const ErrorWeights weights = find_error_weights(s);
  // Late bounces are so dim that their noise needs no smoothing.
  std::vector<float> rough(noise.size());
  for (size_t p = 0; p < rough.size(); ++p) rough[p] = std::abs(mean_channel(noise[p]));
  const double asked = s.settings.error * weights.all;
  if (sum_error_power(s, weights, rough) <= kQuietOfError * asked) return {received, rough};
  SmoothBounce bounce = smooth_bounce(s, received, noise);
  if (sum_error_power(s, weights, bounce.error) <= kLaterOfError * asked) return bounce;
  return gather_aimed(s, ray_count);
}

}  // namespace

const PassReport& advance(Solution& s) {
  const WorkersScope scope(s.workers);
  Stopwatch watch;
  if (!s.mesh.frozen) freeze(s);
  const FaceTable& faces = s.surfaces->faces;
  PassReport report;
  report.pass = static_cast<uint32_t>(s.log.passes.size()) + 1;
  uint64_t aimed = 0;
  SmoothBounce bounce;
  if (report.pass == 1) {
    s.light.sharp = s.light.direct;
    bounce = gather_first(s);
    report.ray_count = s.log.direct_ray_count;
    s.log.factor_count += count_factors(s);
  } else if (report.pass == 2) {
    bounce = gather_aimed(s, aimed);
    report.ray_count = uint64_t{s.transport.hits.ray_count} * s.transport.receivers.size();
  } else {
    bounce = gather_later(s, aimed);
  }
  report.ray_count += aimed;
  s.log.transport_ray_count += aimed;
  s.log.factor_count += aimed;
  s.light.smooth_added = std::move(bounce.received);
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    s.light.smooth_error[p] += bounce.error[p];
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
