// Faces to the meshes that a solution stands on: starting meshes, rounds of refinement, the final mesh.
#include "engine/light/direct.h"
#include "engine/mesh/patches.h"
#include "engine/mesh/refine.h"
#include "engine/solve/sizes.h"
#include "engine/solve/solution.h"
#include "engine/transport/emission_by_rows.h"
#include "engine/transport/gather.h"
#include "engine/transport/receivers.h"
#include "engine/transport/sights.h"

#include <algorithm>
#include <atomic>
#include <cassert>

namespace patchlight {
namespace {

constexpr float kVisibleNoise = 0.02f;  // that smoothing leaves: share of an element's radiosity
// Rays of all elements with shadow edges, at least, as long as each has no more than so many times the usual
// ones.
constexpr size_t kFewEdgesRays = 500'000;
constexpr uint32_t kFewEdgesMost = 8;
constexpr size_t kOwnRowsMax = 60'000;  // patches: beyond, small faces share rows
constexpr float kLargeElement = 6;      // least sizes
// The coarse solution ends when a pass adds less than this share of what it has.
constexpr double kCoarseUntil = 0.005;
constexpr uint32_t kCoarsePassesMax = 64;
constexpr uint32_t kPatchRoundsMax = 3, kAskedRoundsMax = 8;
// Direct light is smoothed by 8 steps at most (smoothing.h).
constexpr uint32_t kDirectStrengths = 5;

// Elements: the patches, split on until they are as small as the settings want them to start.
PatchTable make_elements(const PatchTable& patches, const Surfaces& surfaces, const PatchSizes& sizes) {
  const FaceTable& faces = surfaces.faces;
  const FaceFrameTable& frames = surfaces.frames;
  PatchTable elements = patches;
  std::vector<uint8_t> levels(faces.size());
  for (uint32_t f = 0; f < faces.size(); ++f)
    levels[f] = static_cast<uint8_t>(find_start_level(faces, frames, f, sizes));
  for (;;) {
    std::vector<uint8_t> marks(elements.size());
    bool any = false;
    for (size_t row = 0; row < elements.size(); ++row)
      any |= (marks[row] = elements.level[row] < levels[elements.face[row]]) != 0;
    if (!any) break;
    std::vector<uint32_t> parent;
    elements = split_leaves(elements, frames, marks, parent);
  }
  balance_leaves(elements, frames, surfaces.smooth_links);
  return elements;
}

void find_element_patches(Solution& s) {
  s.mesh.element_first = find_union_ranges(s.mesh.patches, s.mesh.elements);
  s.mesh.element_patch.resize(s.mesh.elements.size());
  for_rows(s.mesh.patches.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p)
      for (uint32_t row = s.mesh.element_first[p]; row < s.mesh.element_first[p + 1]; ++row)
        s.mesh.element_patch[row] = static_cast<uint32_t>(p);
  });
}

// Rays a lamp on the starting mesh, whose elements may be large beside a spot of light, while the mesh is
// refined, and once it is final.
constexpr DirectRays kStartRays{64, 64};
DirectRays round_rays(const SolverSettings& settings) {
  return {16, std::max(count_row_rays(settings) * 4 / 9, 16u)};
}

// Through windows the sky is seen in pieces as small as they are: fine cells, where most rows stay inside.
SkyDetail pick_sky_detail(const Solution& s) {
  constexpr double kOpen = 0.2;
  double open = 0, area = 0;
  for (size_t p = 0; p < s.mesh.patches.size(); ++p) {
    const uint32_t receiver = s.transport.receivers.receiver_of[p];
    open += double{s.mesh.patches.area[p]} * s.transport.hits.nothing[receiver] / s.transport.hits.ray_count;
    area += double{s.mesh.patches.area[p]};
  }
  return open < kOpen * area ? SkyDetail::kFine : SkyDetail::kCoarse;
}

void find_direct_of(Solution& s, std::span<const uint32_t> rows, DirectRays rays) {
  s.log.direct_ray_count += find_exposed(s.mesh, rows, *s.surfaces, s.settings.seed);
  s.log.direct_ray_count +=
      find_direct({s.light.direct, s.light.direct_error, s.light.direct_noise}, rows,
                  {*s.surfaces, s.mesh, s.transport.receivers, s.transport.groups, s.transport.sights}, rays,
                  s.settings.seed);
}

PatchSettings make_patch_settings(const Solution& s, const AskedSizes& asked) {
  return {count_transport_patches(s.surfaces->faces, s.settings), find_size_factor(s.settings),
          s.settings.seed, s.settings.threshold_indirect, asked};
}

// One more bounce of the whole coarse solution, with its standard error: what patches receive of all that the
// others send, from two halves of their rays. direct, emitted: a row a patch, W/m2: the means of the
// elements' direct light, and what rows catch of emission.
void step_coarse(Solution& s, const Rows& rows, std::span<const Rgb> direct, std::span<const Rgb> emitted) {
  const size_t count = s.mesh.patches.size();
  std::vector<Rgb> sent(count), difference(count), received(count);
  for (size_t p = 0; p < count; ++p)
    sent[p] = s.surfaces->faces.reflectance[s.mesh.patches.face[p]] * (direct[p] + s.light.coarse[p]);
  gather_patches(received, difference, rows, sent);
  s.light.coarse_error.resize(count);
  for (size_t p = 0; p < count; ++p) {
    s.light.coarse[p] = emitted[p] + received[p];
    s.light.coarse_error[p] = largest(abs(difference[p]));
  }
}

// All bounces on the patches alone, from the elements' direct light so far: what refinement and exposure go
// by.
void find_coarse(Solution& s, const Rows& rows) {
  const size_t count = s.mesh.patches.size();
  const std::vector<Rgb> direct = find_patch_means(s, s.light.direct);
  std::vector<Rgb> emitted(count), sent(count), next(count);
  gather_emission(emitted, {}, rows, s.transport.emission_by_rows);
  s.light.coarse = emitted;
  for (size_t p = 0; p < count; ++p)
    sent[p] = s.surfaces->faces.reflectance[s.mesh.patches.face[p]] * (direct[p] + emitted[p]);
  for (uint32_t pass = 2; pass <= kCoarsePassesMax; ++pass) {
    gather_patches(next, {}, rows, sent);
    double added = 0, all = 0;
    for (size_t p = 0; p < count; ++p) {
      s.light.coarse[p] += next[p];
      sent[p] = s.surfaces->faces.reflectance[s.mesh.patches.face[p]] * next[p];
      added += double{s.mesh.patches.area[p]} * largest(next[p]);
      all += double{s.mesh.patches.area[p]} * largest(direct[p] + s.light.coarse[p]);
    }
    if (added <= kCoarseUntil * all) break;
  }
  step_coarse(s, rows, direct, emitted);
}

// The coarse solution's radiosity of the elements `rows`.
void find_coarse_radiosity(Solution& s, std::span<const uint32_t> rows) {
  const FaceTable& faces = s.surfaces->faces;
  for_element_values(s, s.light.coarse, rows, [&](uint32_t row, Rgb indirect) {
    const uint32_t face = s.mesh.elements.face[row];
    s.mesh.elements.radiosity[row] =
        faces.emission[face] + faces.reflectance[face] * (s.light.direct[row] + indirect);
  });
}

void find_mean_radiosity(Solution& s) {
  const FaceTable& faces = s.surfaces->faces;
  double sum = 0, area = 0;
  for (size_t row = 0; row < s.mesh.elements.size(); ++row) {
    const double exposed_area = double{s.mesh.elements.area[row]} * s.mesh.elements.exposed[row];
    sum += exposed_area * largest(s.mesh.elements.radiosity[row] - faces.emission[s.mesh.elements.face[row]]);
    area += exposed_area;
  }
  s.light.mean_radiosity = area > 0 ? static_cast<float>(sum / area) : 0;
}

// A row an element, lengths: what the author says, or an automatic size as the surroundings ask for it.
std::vector<float> find_least_sizes(const Solution& s) {
  const PatchSizes sizes = find_patch_sizes(s.surfaces->faces, s.surfaces->frames, s.settings);
  std::vector<float> least(s.mesh.elements.size());
  for (size_t row = 0; row < least.size(); ++row) {
    if (const float asked = sizes.asked.least[s.mesh.elements.face[row]]; asked > 0) {
      least[row] = asked;
      continue;
    }
    least[row] = sizes.least;
    if (s.settings.patch_size <= 0)
      least[row] *= s.mesh.patch_reach[s.mesh.element_patch[row]] / s.surfaces->scale;
  }
  return least;
}

// Standard errors of the elements' coarse radiosities. A difference between two elements of one patch holds
// only their share of the surface's slope, and with it of the rows' noise. The noise of direct light counts
// for small elements only: light that few rays found on a large one is a discovery, and splitting tells what
// it is.
std::vector<float> find_errors(const Solution& s, std::span<const float> patch_size_min) {
  std::vector<float> error(s.mesh.elements.size());
  for_rows(error.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const uint32_t patch = s.mesh.element_patch[row];
      const float slope =
          s.light.coarse_error[patch] * cell_size(s.mesh.elements.level[row] - s.mesh.patches.level[patch]);
      const float edge = longest_edge(cell_corners(s.surfaces->frames, s.mesh.elements.face[row],
                                                   s.mesh.elements.cell[row], s.mesh.elements.level[row]));
      const float direct = edge > kLargeElement * patch_size_min[row] ? 0 : s.light.direct_error[row];
      error[row] =
          largest(s.surfaces->faces.reflectance[s.mesh.elements.face[row]]) * std::hypot(direct, slope);
    }
  });
  return error;
}

template <typename T>
void inherit(std::vector<T>& column, std::span<const uint32_t> parent) {
  std::vector<T> next(parent.size());
  for_rows(parent.size(), 16384, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) next[row] = column[parent[row]];
  });
  column = std::move(next);
}

void split_elements(Solution& s, const std::vector<uint8_t>& marks) {
  std::vector<uint32_t> parent;
  s.mesh.elements = split_leaves(s.mesh.elements, s.surfaces->frames, marks, parent);
  inherit(s.light.direct, parent);
  inherit(s.light.direct_error, parent);
  inherit(s.light.direct_noise, parent);
  inherit(s.mesh.reasons, parent);
  s.mesh.fresh.clear();
  for (uint32_t row = 0; row < parent.size(); ++row)
    if (marks[parent[row]]) s.mesh.fresh.push_back(row);
  find_element_patches(s);
}

// Splits patches beside which the coarse solution changes much; false once none does. Rows of patches that
// stay whole are kept.
bool split_patches(Solution& s, const AskedSizes& sizes) {
  Stopwatch watch;
  const size_t count = s.mesh.patches.size();
  const std::vector<Rgb> direct = find_patch_means(s, s.light.direct);
  std::vector<float> indirect(count), total(count), error(count);
  for (size_t p = 0; p < count; ++p) {
    const Rgb reflectance = s.surfaces->faces.reflectance[s.mesh.patches.face[p]];
    indirect[p] = largest(reflectance * s.light.coarse[p]);
    total[p] = largest(reflectance * (s.light.coarse[p] + direct[p]));
    error[p] = largest(reflectance) * s.light.coarse_error[p];
  }
  const std::vector<uint8_t> marks = mark_uneven(s.mesh.patches, {indirect, total, error, s.mesh.patch_reach},
                                                 *s.surfaces, make_patch_settings(s, sizes));
  if (std::count(marks.begin(), marks.end(), 1) == 0) {
    s.log.split_seconds += watch.lap();
    return false;
  }
  std::vector<uint32_t> parent, row_before, fresh_rows;
  const PatchTable before = std::move(s.mesh.patches);
  s.mesh.patches = split_leaves(before, s.surfaces->frames, marks, parent);
  const ReceiverTable receivers_before = std::move(s.transport.receivers);
  s.transport.receivers = split_receivers(receivers_before, parent, s.mesh.patches, *s.surfaces, row_before);
  std::vector<uint32_t> receiver_before(s.transport.receivers.size());
  for (size_t r = 0; r < receiver_before.size(); ++r)
    receiver_before[r] =
        receivers_before.receiver_of[parent[s.transport.receivers.patch[s.transport.receivers.first[r]]]];
  s.transport.sights = inherit_sights(s.transport.sights, receiver_before);
  move_rows(s.transport.hits, row_before, before, parent);
  for (uint32_t row = 0; row < row_before.size(); ++row)
    if (row_before[row] == kNone) fresh_rows.push_back(row);
  s.mesh.patch_index = make_leaf_index(s.mesh.patches);
  s.mesh.patch_reach =
      find_patch_reach(s.mesh.patches, *s.surfaces, s.settings.seed, s.log.transport_ray_count);
  s.log.split_seconds += watch.lap();
  s.log.transport_ray_count +=
      cast_rows(s.transport.hits, s.mesh.patches.exposed, fresh_rows, get_rows(s).by, s.settings.keep_rows);
  s.log.trace_seconds += watch.lap();
  s.mesh.patch_vertices = make_vertices(s.mesh.patches, s.surfaces->frames, s.surfaces->smooth_links);
  inherit(s.light.coarse, parent);
  // Elements stay parts of patches.
  std::vector<uint8_t> element_marks(s.mesh.elements.size(), 0);
  for (size_t row = 0; row < element_marks.size(); ++row) {
    const uint32_t patch = s.mesh.element_patch[row];
    element_marks[row] = marks[patch] && s.mesh.elements.level[row] == before.level[patch];
  }
  const std::vector<uint8_t> asked = element_marks;
  mark_for_balance(element_marks, s.mesh.elements, s.surfaces->frames, s.surfaces->smooth_links);
  for (size_t row = 0; row < element_marks.size(); ++row)
    if (element_marks[row]) s.mesh.reasons[row] = asked[row] ? SplitReason::kIndirect : SplitReason::kBalance;
  split_elements(s, element_marks);
  s.log.split_seconds += watch.lap();
  find_direct_of(s, s.mesh.fresh, round_rays(s.settings));
  s.log.trace_seconds += watch.lap();
  const Rows rows = get_rows(s);
  std::vector<Rgb> emitted(s.mesh.patches.size());
  gather_emission(emitted, {}, rows, s.transport.emission_by_rows);
  step_coarse(s, rows, find_patch_means(s, s.light.direct), emitted);
  s.log.solve_seconds += watch.lap();
  return true;
}

// Elements whose direct light is noisy: those that see all of a lamp or nothing of it keep what they have.
std::vector<uint32_t> find_noisy_elements(const Solution& s) {
  std::vector<uint32_t> rows;
  for (uint32_t row = 0; row < s.light.direct_noise.size(); ++row)
    if (s.light.direct_noise[row] != 0) rows.push_back(row);
  return rows;
}

// What smoothing would leave of the error of direct light, a row an element, W/m2.
std::vector<float> find_error_left(const Solution& s) {
  std::vector<float> left = s.light.direct_error;
  const std::vector<uint32_t> noisy = find_noisy_elements(s);
  const SmoothingTable smoothing = make_smoothing(s.mesh.elements, *s.surfaces, noisy);
  std::vector<Rgb> direct = s.light.direct;
  std::vector<float> noise = s.light.direct_noise, error(left.size());
  smooth_noise({direct, noise, error}, smoothing, kDirectStrengths);
  for (const uint32_t row : smoothing.leaf) left[row] = std::min(left[row], error[row]);
  return left;
}

// Elements with a shadow edge in them whose noise would show though it is smoothed, and their neighbours,
// where sixteen rays may have missed one.
std::vector<uint32_t> find_shadow_edges(const Solution& s) {
  const std::vector<float> left = find_error_left(s);
  std::vector<uint8_t> near(s.mesh.elements.size(), 0);
  for_rows(near.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      if (s.light.direct_error[row] == 0) continue;
      // On black surfaces no noise shows; there the irradiance itself is what is asked for.
      const float reflectance = largest(s.surfaces->faces.reflectance[s.mesh.elements.face[row]]);
      const float shown = reflectance * left[row];
      if (reflectance > 0 && shown <= kVisibleNoise * largest(s.mesh.elements.radiosity[row])) continue;
      std::atomic_ref<uint8_t>(near[row]).store(1, std::memory_order_relaxed);
      for (uint32_t edge = 0; edge < edge_count(s.surfaces->frames, s.mesh.elements.face[row]); ++edge)
        for (const uint32_t other : find_neighbours(s.mesh.elements, s.surfaces->frames, s.surfaces->links,
                                                    static_cast<uint32_t>(row), edge))
          if (other != kNone) std::atomic_ref<uint8_t>(near[other]).store(1, std::memory_order_relaxed);
    }
  });
  std::vector<uint32_t> rows;
  for (uint32_t row = 0; row < near.size(); ++row)
    if (near[row]) rows.push_back(row);
  return rows;
}

// Less noise where emitters are seen in part. The error that is told of it is what smoothing leaves.
void smooth_direct(Solution& s) {
  const SmoothingTable smoothing = make_smoothing(s.mesh.elements, *s.surfaces, find_noisy_elements(s));
  if (smoothing.size() > 0) {
    std::vector<float> error(s.mesh.elements.size());
    const std::vector<Rgb> before = s.light.direct;
    smooth_noise({s.light.direct, s.light.direct_noise, error}, smoothing, kDirectStrengths);
    keep_power(s.light.direct, before, smoothing, s.mesh.elements, s.surfaces->faces);
    s.light.direct_error = std::move(error);
  }
  s.light.direct_noise = {};
}

}  // namespace

Solution make_solution(std::shared_ptr<const Surfaces> surfaces, const SolverSettings& settings,
                       std::shared_ptr<Workers> workers) {
  Solution s;
  s.surfaces = std::move(surfaces), s.settings = settings, s.workers = std::move(workers);
  const WorkersScope scope(s.workers);
  Stopwatch watch, whole;
  uint64_t& ray_count = s.log.transport_ray_count;
  const AskedSizes asked = find_asked_sizes(s.surfaces->faces, settings);
  s.mesh.patches = make_patches(*s.surfaces, make_patch_settings(s, asked), ray_count);
  s.mesh.patch_reach = find_patch_reach(s.mesh.patches, *s.surfaces, settings.seed, ray_count);
  // Where patches are few a row each costs little, and no light that differs among them is lost.
  s.transport.receivers = s.mesh.patches.size() <= kOwnRowsMax
                              ? make_single_receivers(s.mesh.patches, *s.surfaces)
                              : make_receivers(s.mesh.patches, *s.surfaces, settings.seed, ray_count);
  s.log.split_seconds += watch.lap();
  s.mesh.patch_index = make_leaf_index(s.mesh.patches);
  ray_count += cast_rows(s.transport.hits, s.mesh.patches.exposed, all_rows(s.transport.receivers.size()),
                         get_rows(s).by, settings.keep_rows);
  s.log.trace_seconds += watch.lap();
  s.mesh.patch_vertices = make_vertices(s.mesh.patches, s.surfaces->frames, s.surfaces->smooth_links);
  s.mesh.elements = make_elements(s.mesh.patches, *s.surfaces,
                                  find_patch_sizes(s.surfaces->faces, s.surfaces->frames, settings));
  find_element_patches(s);
  s.log.split_seconds += watch.lap();
  s.transport.groups =
      make_emitter_groups(s.surfaces->faces, s.surfaces->frames, s.surfaces->sky, pick_sky_detail(s));
  s.transport.emission_by_rows =
      find_emission_by_rows(*s.surfaces, s.transport.groups, s.mesh.patches, s.transport.receivers);
  s.transport.sights = find_sights(get_rows(s), s.transport.groups, s.transport.emission_by_rows, ray_count);
  const size_t count = s.mesh.elements.size();
  s.light.direct.resize(count);
  s.light.direct_error.resize(count);
  s.light.direct_noise.resize(count);
  s.mesh.reasons.assign(count, SplitReason::kStart);
  s.mesh.fresh = all_rows(count);
  find_direct_of(s, s.mesh.fresh, kStartRays);
  s.log.trace_seconds += watch.lap();
  find_coarse(s, get_rows(s));
  s.log.solve_seconds += watch.lap();
  // Where the author lets patches start coarse, light takes more rounds to find where they are to be fine.
  const bool is_asked =
      std::any_of(asked.start.begin(), asked.start.end(), [](float edge) { return edge > 0; });
  const uint32_t rounds = is_asked ? kAskedRoundsMax : kPatchRoundsMax;
  for (uint32_t round = 0; round < rounds && split_patches(s, asked); ++round) {
  }
  watch = {};  // the rounds told their time themselves
  s.mesh.fresh = all_rows(s.mesh.elements.size());
  find_coarse_radiosity(s, s.mesh.fresh);
  find_mean_radiosity(s);
  s.log.solve_seconds += watch.lap();
  s.log.rounds.push_back(
      {1, s.mesh.elements.size(), 0, s.log.transport_ray_count + s.log.direct_ray_count, whole.lap()});
  return s;
}

bool refine(Solution& s) {
  assert(!s.mesh.frozen);
  const WorkersScope scope(s.workers);
  Stopwatch watch, whole;
  const uint64_t rays_before = s.log.direct_ray_count;
  const std::vector<float> patch_size_min = find_least_sizes(s);
  const float threshold = s.settings.threshold;
  const std::vector<float> error = find_errors(s, patch_size_min);
  const RefineInput input{s.mesh.elements, s.light.direct, error, s.mesh.fresh, s.light.mean_radiosity};
  const std::vector<uint8_t> marks =
      mark_differing(input, *s.surfaces, {threshold, patch_size_min, s.settings.patch_count_max});
  const auto split_count = static_cast<uint64_t>(std::count(marks.begin(), marks.end(), 1));
  if (split_count == 0) {
    s.log.split_seconds += watch.lap();
    return false;
  }
  find_split_reasons(s.mesh.reasons, marks, input, *s.surfaces, threshold);
  split_elements(s, marks);
  s.log.split_seconds += watch.lap();
  find_direct_of(s, s.mesh.fresh, round_rays(s.settings));
  s.log.trace_seconds += watch.lap();
  find_coarse_radiosity(s, s.mesh.fresh);
  s.log.solve_seconds += watch.lap();
  s.log.rounds.push_back({s.log.rounds.back().round + 1, s.mesh.elements.size(), split_count,
                          s.log.direct_ray_count - rays_before, whole.lap()});
  return true;
}

void freeze(Solution& s) {
  assert(!s.mesh.frozen);
  const WorkersScope scope(s.workers);
  Stopwatch watch;
  const std::vector<uint32_t> shadow_edges = find_shadow_edges(s);
  DirectRays rays = final_rays(s.settings);
  // Where edges are few more rays cost nothing, and little averages out.
  rays.mixed = std::clamp(static_cast<uint32_t>(kFewEdgesRays / std::max(shadow_edges.size(), size_t{1})),
                          rays.mixed, kFewEdgesMost * rays.mixed);
  find_direct_of(s, shadow_edges, rays);
  smooth_direct(s);
  s.log.trace_seconds += watch.lap();
  s.mesh.fresh = {};
  s.mesh.element_vertices = make_vertices(s.mesh.elements, s.surfaces->frames, s.surfaces->smooth_links);
  for (PatchTable* table : {&s.mesh.elements, &s.mesh.patches})
    for_rows(table->size(), 16384, [&](size_t begin, size_t end) {
      for (size_t row = begin; row < end; ++row)
        table->radiosity[row] = table->unshot[row] = s.surfaces->faces.emission[table->face[row]];
    });
  s.light.sharp.assign(s.mesh.elements.size(), Rgb(0));
  s.light.smooth.assign(s.mesh.patches.size(), Rgb(0));
  s.light.smooth_added.assign(s.mesh.patches.size(), Rgb(0));
  s.light.smooth_error.assign(s.mesh.patches.size(), 0);
  s.transport.smoothing = make_smoothing(s.mesh.patches, *s.surfaces, all_rows(s.mesh.patches.size()));
  s.mesh.frozen = true;
  s.log.split_seconds += watch.lap();
}

}  // namespace patchlight
