// Faces to the meshes that a solution stands on: starting meshes, rounds of refinement, the final mesh.
#include "aims.h"
#include "direct.h"
#include "gather.h"
#include "patches.h"
#include "receivers.h"
#include "refine.h"
#include "solution.h"

#include <algorithm>
#include <atomic>
#include <cassert>

namespace patchlight {
namespace {

constexpr float kVisibleNoise = 0.005f;  // share of an element's radiosity
constexpr float kLargeElement = 6;       // least sizes
// The coarse solution ends when a pass adds less than this share of what it has.
constexpr double kCoarseUntil = 0.005;
constexpr uint32_t kCoarsePassesMax = 64;
constexpr uint32_t kPatchRoundsMax = 3;

// Elements: the patches, split on until they are as small as the settings want them to start.
PatchTable make_elements(const PatchTable& patches, const FaceTable& faces, const FaceFrameTable& frames,
                         const FaceLinkTable& links, float patch_size) {
  PatchTable elements = patches;
  std::vector<uint8_t> levels(faces.size());
  for (uint32_t f = 0; f < faces.size(); ++f)
    levels[f] = static_cast<uint8_t>(find_start_level(faces, frames, f, patch_size));
  for (;;) {
    std::vector<uint8_t> marks(elements.size());
    bool any = false;
    for (size_t row = 0; row < elements.size(); ++row)
      any |= (marks[row] = elements.level[row] < levels[elements.face[row]]) != 0;
    if (!any) break;
    std::vector<uint32_t> parent;
    elements = split_leaves(elements, frames, marks, parent);
  }
  balance_leaves(elements, frames, links);
  return elements;
}

void find_element_patches(Solution& s) {
  s.element_first = find_union_ranges(s.patches, s.elements);
  s.element_patch.resize(s.elements.size());
  for_rows(s.patches.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p)
      for (uint32_t row = s.element_first[p]; row < s.element_first[p + 1]; ++row)
        s.element_patch[row] = static_cast<uint32_t>(p);
  });
}

// Rays a lamp on the starting mesh, whose elements may be large beside a spot of light, while the mesh is
// refined, and once it is final.
constexpr DirectRays kStartRays{64, 64};
DirectRays round_rays(const SolverSettings& settings) {
  return {16, std::max(count_row_rays(settings) / 4, 16u)};
}
DirectRays final_rays(const SolverSettings& settings) {
  return {std::max(count_row_rays(settings) / 8, 16u), std::max(count_row_rays(settings) / 2, 16u)};
}

void find_direct_of(Solution& s, std::span<const uint32_t> rows, const FaceTable& faces, const Tracer& tracer,
                    DirectRays rays, const SolverSettings& settings) {
  s.direct_ray_count +=
      find_exposed(s.elements, rows, s.element_patch, s.patches, faces, s.frames, tracer, settings.seed);
  s.direct_ray_count += find_direct({s.direct, s.direct_error, s.views}, rows, s.elements, s.aims, faces,
                                    s.frames, tracer, rays, settings.seed);
}

// One more bounce of the whole coarse solution, with its standard error: what patches receive of all that the
// others send, from two halves of their rays. direct, emitted: a row a patch, W/m2: the means of the
// elements' direct light, and what rows catch of emission.
void step_coarse(Solution& s, const Rows& rows, const FaceTable& faces, std::span<const Rgb> direct,
                 std::span<const Rgb> emitted) {
  const size_t count = s.patches.size();
  std::vector<Rgb> sent(count), difference(count), received(count);
  for (size_t p = 0; p < count; ++p)
    sent[p] = faces.reflectance[s.patches.face[p]] * (direct[p] + s.coarse[p]);
  gather_patches(received, difference, rows, sent);
  s.coarse_error.resize(count);
  for (size_t p = 0; p < count; ++p) {
    s.coarse[p] = emitted[p] + received[p];
    s.coarse_error[p] = largest(difference[p]);
  }
}

// All bounces on the patches alone, from the elements' direct light so far: what refinement and exposure go
// by.
void find_coarse(Solution& s, const Rows& rows, const FaceTable& faces) {
  const size_t count = s.patches.size();
  const std::vector<Rgb> direct = find_patch_means(s, s.direct);
  std::vector<Rgb> emitted(count), sent(count), next(count);
  gather_emission(emitted, rows, s.aims);
  s.coarse = emitted;
  for (size_t p = 0; p < count; ++p)
    sent[p] = faces.reflectance[s.patches.face[p]] * (direct[p] + emitted[p]);
  for (uint32_t pass = 2; pass <= kCoarsePassesMax; ++pass) {
    gather_patches(next, {}, rows, sent);
    double added = 0, all = 0;
    for (size_t p = 0; p < count; ++p) {
      s.coarse[p] += next[p];
      sent[p] = faces.reflectance[s.patches.face[p]] * next[p];
      added += double{s.patches.area[p]} * largest(next[p]);
      all += double{s.patches.area[p]} * largest(direct[p] + s.coarse[p]);
    }
    if (added <= kCoarseUntil * all) break;
  }
  step_coarse(s, rows, faces, direct, emitted);
}

// The coarse solution's radiosity of the elements `rows`.
void find_coarse_radiosity(Solution& s, std::span<const uint32_t> rows, const FaceTable& faces) {
  for_element_values(s, s.coarse, rows, [&](uint32_t row, Rgb indirect) {
    const uint32_t face = s.elements.face[row];
    s.elements.radiosity[row] = faces.emission[face] + faces.reflectance[face] * (s.direct[row] + indirect);
  });
}

void find_mean_radiosity(Solution& s, const FaceTable& faces) {
  double sum = 0, area = 0;
  for (size_t row = 0; row < s.elements.size(); ++row) {
    const double exposed_area = double{s.elements.area[row]} * s.elements.exposed[row];
    sum += exposed_area * largest(s.elements.radiosity[row] - faces.emission[s.elements.face[row]]);
    area += exposed_area;
  }
  s.mean_radiosity = area > 0 ? static_cast<float>(sum / area) : 0;
}

// Standard errors of the elements' coarse radiosities. A difference between two elements of one patch holds
// only their share of the surface's slope, and with it of the rows' noise. The noise of direct light counts
// for small elements only: light that few rays found on a large one is a discovery, and splitting tells what
// it is.
std::vector<float> find_errors(const Solution& s, const FaceTable& faces, float patch_size_min) {
  std::vector<float> error(s.elements.size());
  for_rows(error.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const uint32_t patch = s.element_patch[row];
      const float slope = s.coarse_error[patch] * cell_size(s.elements.level[row] - s.patches.level[patch]);
      const float edge = longest_edge(
          cell_corners(s.frames, s.elements.face[row], s.elements.cell[row], s.elements.level[row]));
      const float direct = edge > kLargeElement * patch_size_min ? 0 : s.direct_error[row];
      error[row] = largest(faces.reflectance[s.elements.face[row]]) * std::hypot(direct, slope);
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
  for_rows(s.elements.size(), 512, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row)
      if (marks[row])
        // Not what was settled before: a neighbour may have found light since.
        s.views.settled[row] =
            find_settled(s.views, s.elements, s.frames, s.links, static_cast<uint32_t>(row));
  });
  std::vector<uint32_t> parent;
  s.elements = split_leaves(s.elements, s.frames, marks, parent);
  inherit(s.direct, parent);
  inherit(s.direct_error, parent);
  inherit(s.views.seen, parent);
  inherit(s.views.hidden, parent);
  inherit(s.views.settled, parent);
  inherit(s.reasons, parent);
  s.fresh.clear();
  for (uint32_t row = 0; row < parent.size(); ++row)
    if (marks[parent[row]]) s.fresh.push_back(row);
  find_element_patches(s);
}

// Splits patches beside which the coarse solution changes much; false once none does. Rows of patches that
// stay whole are kept.
bool split_patches(Solution& s, const FaceTable& faces, const Tracer& tracer,
                   const SolverSettings& settings) {
  Stopwatch watch;
  const size_t count = s.patches.size();
  const std::vector<Rgb> direct = find_patch_means(s, s.direct);
  std::vector<float> indirect(count), total(count), error(count);
  for (size_t p = 0; p < count; ++p) {
    const Rgb reflectance = faces.reflectance[s.patches.face[p]];
    indirect[p] = largest(reflectance * s.coarse[p]);
    total[p] = largest(reflectance * (s.coarse[p] + direct[p]));
    error[p] = largest(reflectance) * s.coarse_error[p];
  }
  const std::vector<uint8_t> marks =
      mark_uneven(s.patches, {indirect, total, error}, faces, s.frames, s.links, s.joints,
                  count_transport_patches(faces, settings), find_size_factor(settings));
  if (std::count(marks.begin(), marks.end(), 1) == 0) {
    s.seconds.split += watch.read();
    return false;
  }
  std::vector<uint32_t> parent, row_before, fresh_rows;
  const PatchTable before = std::move(s.patches);
  s.patches = split_leaves(before, s.frames, marks, parent);
  s.receivers = split_receivers(s.receivers, parent, s.patches, faces, s.frames, row_before);
  move_rows(s.hits, row_before, before, parent);
  for (uint32_t row = 0; row < row_before.size(); ++row)
    if (row_before[row] == kNone) fresh_rows.push_back(row);
  s.patch_index = make_leaf_index(s.patches);
  s.seconds.split += watch.read();
  s.transport_ray_count +=
      cast_rows(s.hits, s.patches, fresh_rows, s.patch_index, s.receivers, faces, s.frames, tracer,
                {count_row_rays(settings), settings.seed, settings.keep_rows});
  s.seconds.trace += watch.read();
  s.patch_vertices = make_vertices(s.patches, s.frames, s.joints);
  inherit(s.coarse, parent);
  // Elements stay parts of patches.
  std::vector<uint8_t> element_marks(s.elements.size(), 0);
  for (size_t row = 0; row < element_marks.size(); ++row) {
    const uint32_t patch = s.element_patch[row];
    element_marks[row] = marks[patch] && s.elements.level[row] == before.level[patch];
  }
  const std::vector<uint8_t> asked = element_marks;
  mark_for_balance(element_marks, s.elements, s.frames, s.joints);
  for (size_t row = 0; row < element_marks.size(); ++row)
    if (element_marks[row]) s.reasons[row] = asked[row] ? SplitReason::kIndirect : SplitReason::kBalance;
  split_elements(s, element_marks);
  s.seconds.split += watch.read();
  find_direct_of(s, s.fresh, faces, tracer, round_rays(settings), settings);
  s.seconds.trace += watch.read();
  const Rows rows = get_rows(s, faces, tracer, settings);
  std::vector<Rgb> emitted(s.patches.size());
  gather_emission(emitted, rows, s.aims);
  step_coarse(s, rows, faces, find_patch_means(s, s.direct), emitted);
  s.seconds.solve += watch.read();
  return true;
}

// Elements with a shadow edge in them whose noise would show, and their neighbours, where sixteen rays may
// have missed one.
std::vector<uint32_t> find_shadow_edges(const Solution& s, const FaceTable& faces) {
  std::vector<uint8_t> near(s.elements.size(), 0);
  for_rows(near.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      if (s.direct_error[row] == 0) continue;
      // On black surfaces no noise shows; there the irradiance itself is what is asked for.
      const float reflectance = largest(faces.reflectance[s.elements.face[row]]);
      const float shown = reflectance * s.direct_error[row];
      if (reflectance > 0 && shown <= kVisibleNoise * largest(s.elements.radiosity[row])) continue;
      std::atomic_ref<uint8_t>(near[row]).store(1, std::memory_order_relaxed);
      for (uint32_t edge = 0; edge < edge_count(s.frames, s.elements.face[row]); ++edge)
        for (const uint32_t other :
             find_neighbours(s.elements, s.frames, s.links, static_cast<uint32_t>(row), edge))
          if (other != kNone) std::atomic_ref<uint8_t>(near[other]).store(1, std::memory_order_relaxed);
    }
  });
  std::vector<uint32_t> rows;
  for (uint32_t row = 0; row < near.size(); ++row)
    if (near[row]) rows.push_back(row);
  return rows;
}

}  // namespace

Solution make_solution(const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings) {
  Solution s;
  Stopwatch watch, whole;
  uint64_t& ray_count = s.transport_ray_count;
  s.frames = make_face_frames(faces);
  s.links = make_face_links(faces);
  s.joints = join_smooth_edges(s.links, faces);
  s.patches = make_patches(faces, s.frames, s.joints, tracer, count_transport_patches(faces, settings),
                           find_size_factor(settings), settings.seed, ray_count);
  s.receivers = make_receivers(s.patches, faces, s.frames, tracer, settings.seed, ray_count);
  s.seconds.split += watch.read();
  s.patch_index = make_leaf_index(s.patches);
  ray_count += cast_rows(s.hits, s.patches, all_rows(s.receivers.size()), s.patch_index, s.receivers, faces,
                         s.frames, tracer, {count_row_rays(settings), settings.seed, settings.keep_rows});
  s.seconds.trace += watch.read();
  s.patch_vertices = make_vertices(s.patches, s.frames, s.joints);
  s.elements =
      make_elements(s.patches, faces, s.frames, s.joints, find_patch_sizes(faces, s.frames, settings).start);
  find_element_patches(s);
  s.seconds.split += watch.read();
  s.aims = make_aims(faces, s.frames, s.patches, s.receivers);
  const size_t count = s.elements.size();
  s.direct.resize(count);
  s.direct_error.resize(count);
  s.views.seen.assign(count, 0);
  s.views.hidden.assign(count, 0);
  s.views.settled.assign(count, 0);
  s.reasons.assign(count, SplitReason::kStart);
  s.fresh = all_rows(count);
  find_direct_of(s, s.fresh, faces, tracer, kStartRays, settings);
  s.seconds.trace += watch.read();
  find_coarse(s, get_rows(s, faces, tracer, settings), faces);
  s.seconds.solve += watch.read();
  for (uint32_t round = 0; round < kPatchRoundsMax && split_patches(s, faces, tracer, settings); ++round) {
  }
  watch = {};  // the rounds told their time themselves
  s.fresh = all_rows(s.elements.size());
  find_coarse_radiosity(s, s.fresh, faces);
  find_mean_radiosity(s, faces);
  s.seconds.solve += watch.read();
  s.rounds.push_back({1, s.elements.size(), 0, s.transport_ray_count + s.direct_ray_count, whole.read()});
  return s;
}

bool refine(Solution& s, const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings) {
  assert(!s.frozen);
  Stopwatch watch, whole;
  const uint64_t rays_before = s.direct_ray_count;
  const float patch_size_min = find_patch_sizes(faces, s.frames, settings).least;
  const std::vector<float> error = find_errors(s, faces, patch_size_min);
  const RefineInput input{s.elements, error, s.fresh, s.mean_radiosity};
  const std::vector<uint8_t> marks = mark_differing(input, s.frames, s.links, s.joints, settings.threshold,
                                                    patch_size_min, settings.patch_count_max);
  const auto split_count = static_cast<uint64_t>(std::count(marks.begin(), marks.end(), 1));
  if (split_count == 0) {
    s.seconds.split += watch.read();
    return false;
  }
  find_split_reasons(s.reasons, marks, input, s.direct, faces, s.frames, s.links, settings.threshold);
  split_elements(s, marks);
  s.seconds.split += watch.read();
  find_direct_of(s, s.fresh, faces, tracer, round_rays(settings), settings);
  s.seconds.trace += watch.read();
  find_coarse_radiosity(s, s.fresh, faces);
  s.seconds.solve += watch.read();
  s.rounds.push_back({s.rounds.back().round + 1, s.elements.size(), split_count,
                      s.direct_ray_count - rays_before, whole.read()});
  return true;
}

void freeze(Solution& s, const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings) {
  assert(!s.frozen);
  Stopwatch watch;
  find_direct_of(s, find_shadow_edges(s, faces), faces, tracer, final_rays(settings), settings);
  s.seconds.trace += watch.read();
  s.views = {};
  s.fresh = {};
  s.element_vertices = make_vertices(s.elements, s.frames, s.joints);
  for (PatchTable* table : {&s.elements, &s.patches})
    for_rows(table->size(), 16384, [&](size_t begin, size_t end) {
      for (size_t row = begin; row < end; ++row)
        table->radiosity[row] = table->unshot[row] = faces.emission[table->face[row]];
    });
  s.irradiance.assign(s.patches.size(), Rgb(0));
  s.irradiance_added.assign(s.patches.size(), Rgb(0));
  s.frozen = true;
  s.seconds.split += watch.read();
}

}  // namespace patchlight
