// Joins the kernels: meshes, refinement rounds, passes.
//
// B after pass k is the sum over m = 0..k of (rho F)^m E: B starts as E, and every pass adds what the patches
// receive of the radiosity that the pass before added (Goral, Torrance, Greenberg, Battaile: Modeling the
// Interaction of Light Between Diffuse Surfaces, 1984; the Neumann series of Kajiya: The Rendering Equation,
// 1986).
#include "solve.h"

#include "direct.h"
#include "gather.h"
#include "parallel.h"
#include "receivers.h"
#include "refine.h"
#include "rows.h"
#include "vertices.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <chrono>
#include <numeric>

namespace patchlight {
namespace {

// Of the square root of the scene's area, unless the user says otherwise.
constexpr float kPatchSize = 1 / 30.0f;
// Of the starting patch size.
constexpr float kPatchSizeMin = 1 / 64.0f;
constexpr float kVisibleNoise = 0.005f;  // share of an element's radiosity
constexpr float kLargeElement = 6;       // least sizes
constexpr uint32_t kSourceCount = 400;
// The coarse solution ends when a pass adds less than this share of what it has.
constexpr double kCoarseUntil = 0.005;
constexpr uint32_t kCoarsePassesMax = 64;
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

// How often a face is halved before the first round.
uint32_t find_start_level(const FaceTable& faces, const FaceFrameTable& frames, uint32_t face,
                          float patch_size) {
  const float wanted = faces.patch_size[face] > 0 ? faces.patch_size[face] : patch_size;
  uint32_t level = faces.level_min[face];
  // A hair of slack: an edge of exactly twice the patch size is halved once.
  float edge = std::ldexp(longest_edge(cell_corners(frames, face, 0, 0)), -static_cast<int>(level));
  while (edge > wanted * 1.0001f && level < kLevelMax) edge /= 2, ++level;
  return std::min(level, kLevelMax - 1);
}

uint64_t count_leaves_at_start(const FaceTable& faces, const FaceFrameTable& frames, float patch_size) {
  uint64_t count = 0;
  for (uint32_t f = 0; f < faces.size(); ++f)
    count += uint64_t{1} << 2 * find_start_level(faces, frames, f, patch_size);
  return count;
}

// How many patches may carry light between surfaces: one a face, and half of what that leaves of the budget,
// but no more than rooms need (4,000 to 15,000; a room of a million elements is no harder).
uint64_t count_transport_patches(const FaceTable& faces, const SolverSettings& settings) {
  constexpr uint64_t kMore = 24000;
  const uint64_t face_count = faces.size(), budget = std::max<uint64_t>(settings.patch_count_max, face_count);
  return face_count + std::min((budget - face_count) / 2, kMore);
}

struct PatchSizes {
  float start, least;
};
PatchSizes find_patch_sizes(const FaceTable& faces, const FaceFrameTable& frames,
                            const SolverSettings& settings) {
  float start = settings.patch_size;
  if (start <= 0) {
    // An automatic size leaves half of what the faces themselves do not take of the budget to the rounds.
    const float scale = find_scene_scale(faces, frames);
    const uint64_t face_count = std::min<uint64_t>(faces.size(), settings.patch_count_max);
    const uint64_t most = face_count + (settings.patch_count_max - face_count) / 2;
    start = kPatchSize * scale;
    while (start < scale && count_leaves_at_start(faces, frames, start) > most) start *= 1.25f;
  }
  return {start, settings.patch_size_min > 0 ? settings.patch_size_min : kPatchSizeMin * start};
}

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

// Mean over the exposed area of each patch of a column of its elements.
std::vector<Rgb> find_patch_means(const Solution& s, std::span<const Rgb> column) {
  std::vector<Rgb> means(s.patches.size(), Rgb(0));
  for_rows(means.size(), 256, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      Rgb sum(0);
      float area = 0;
      for (uint32_t row = s.element_first[p]; row < s.element_first[p + 1]; ++row) {
        const float exposed_area = s.elements.area[row] * s.elements.exposed[row];
        sum += exposed_area * column[row];
        area += exposed_area;
      }
      if (area > 0) means[p] = sum / area;
    }
  });
  return means;
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

std::vector<uint32_t> all_rows(size_t count) {
  std::vector<uint32_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0u);
  return rows;
}

// Rays a lamp on the starting mesh, whose elements may be large beside a spot of light, while the mesh is
// refined, and once it is final.
constexpr DirectRays kStartRays{64, 64};
DirectRays round_rays(const SolverSettings& settings) { return {16, std::max(settings.rays / 4, 16u)}; }
DirectRays final_rays(const SolverSettings& settings) {
  return {std::max(settings.rays / 8, 16u), std::max(settings.rays / 2, 16u)};
}

void find_direct_of(Solution& s, std::span<const uint32_t> rows, const FaceTable& faces, const Tracer& tracer,
                    DirectRays rays, const SolverSettings& settings) {
  s.direct_ray_count +=
      find_exposed(s.elements, rows, s.element_patch, s.patches, faces, s.frames, tracer, settings.seed);
  s.direct_ray_count += find_direct({s.direct, s.direct_error, s.views}, rows, s.elements, s.aims, faces,
                                    s.frames, tracer, rays, settings.seed);
}

// All bounces on the patches alone, from the elements' direct light so far: what refinement and exposure go
// by.
void find_coarse(Solution& s, const Rows& rows, const FaceTable& faces) {
  const size_t count = s.patches.size();
  const std::vector<Rgb> direct = find_patch_means(s, s.direct);
  std::vector<Rgb> sent(count), error(count, Rgb(0)), difference(count), next(count);
  gather_emission(next, rows, s.aims);
  s.coarse = next;
  for (size_t p = 0; p < count; ++p) sent[p] = faces.reflectance[s.patches.face[p]] * (direct[p] + next[p]);
  for (uint32_t pass = 2; pass <= kCoarsePassesMax; ++pass) {
    gather_patches(next, difference, rows, sent);
    double added = 0, all = 0;
    for (size_t p = 0; p < count; ++p) {
      s.coarse[p] += next[p];
      error[p] += difference[p];
      sent[p] = faces.reflectance[s.patches.face[p]] * next[p];
      added += double{s.patches.area[p]} * largest(next[p]);
      all += double{s.patches.area[p]} * largest(direct[p] + s.coarse[p]);
    }
    if (added <= kCoarseUntil * all) break;
  }
  s.coarse_error.resize(count);
  for (size_t p = 0; p < count; ++p) s.coarse_error[p] = largest(error[p]);
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
  s.fresh.clear();
  for (uint32_t row = 0; row < parent.size(); ++row)
    if (marks[parent[row]]) s.fresh.push_back(row);
  find_element_patches(s);
}

// Irradiance at the corners of the elements: their direct light, and the surface of `patch_irradiance`.
std::vector<Rgb> find_vertex_radiosity(const Solution& s, const FaceTable& faces, const VertexTable& vertices,
                                       std::span<const Rgb> patch_irradiance, bool with_direct) {
  const std::vector<Rgb> indirect =
      reconstruct(s.patch_vertices, s.patches, s.frames, patch_irradiance, kIndirectSurface);
  std::vector<Rgb> values = with_direct
                                ? reconstruct(vertices, s.elements, s.frames, s.direct, kDirectSurface)
                                : std::vector<Rgb>(vertices.size(), Rgb(0));
  for_rows(vertices.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const uint32_t row = vertices.vertex_leaf[vertices.vertex_first[v]], face = s.elements.face[row];
      const auto& corner = vertices.leaf_vertex[row];
      const size_t k = static_cast<size_t>(std::find(corner.begin(), corner.end(), v) - corner.begin());
      const Vec2 uv =
          cell_corner_parameters(s.frames.triangle[face], s.elements.cell[row], s.elements.level[row])[k];
      const Rgb received = values[v] + sample_surface(s.patch_vertices, s.patches, s.frames, indirect,
                                                      s.element_patch[row], uv);
      values[v] = faces.emission[face] + faces.reflectance[face] * received;
    }
  });
  return values;
}

}  // namespace

Solution make_solution(const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings) {
  Solution s;
  Stopwatch watch, whole;
  uint64_t ray_count = 0;
  s.frames = make_face_frames(faces);
  s.links = make_face_links(faces);
  s.joints = join_smooth_edges(s.links, faces);
  s.patches = make_patches(faces, s.frames, s.joints, tracer, count_transport_patches(faces, settings),
                           settings.seed, ray_count);
  s.receivers = make_receivers(s.patches, faces, s.frames, tracer, settings.seed, ray_count);
  s.seconds.split += watch.read();
  s.patch_index = make_leaf_index(s.patches);
  ray_count += cast_rows(s.hits, s.patches, s.patch_index, s.receivers, faces, s.frames, tracer,
                         {settings.rays, settings.seed, settings.keep_rows});
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
  s.fresh = all_rows(count);
  find_direct_of(s, s.fresh, faces, tracer, kStartRays, settings);
  s.seconds.trace += watch.read();
  find_coarse(s, get_rows(s, faces, tracer, settings), faces);
  find_coarse_radiosity(s, s.fresh, faces);
  find_mean_radiosity(s, faces);
  s.seconds.solve += watch.read();
  s.transport_ray_count = ray_count;
  s.rounds.push_back({1, count, 0, ray_count + s.direct_ray_count, whole.read()});
  return s;
}

Rows get_rows(const Solution& s, const FaceTable& faces, const Tracer& tracer,
              const SolverSettings& settings) {
  return {s.hits,       s.patch_index, s.receivers, s.patches,
          faces,        s.frames,      tracer,      make_row_grid(settings.rays),
          settings.seed};
}

bool refine(Solution& s, const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings) {
  assert(!s.frozen);
  Stopwatch watch, whole;
  const uint64_t rays_before = s.direct_ray_count;
  const float patch_size_min = find_patch_sizes(faces, s.frames, settings).least;
  const std::vector<float> error = find_errors(s, faces, patch_size_min);
  const std::vector<uint8_t> marks =
      mark_differing({s.elements, error, s.fresh, s.mean_radiosity}, s.frames, s.links, s.joints,
                     settings.threshold, patch_size_min, settings.patch_count_max);
  const auto split_count = static_cast<uint64_t>(std::count(marks.begin(), marks.end(), 1));
  if (split_count == 0) {
    s.seconds.split += watch.read();
    return false;
  }
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

void freeze(Solution& s, const FaceTable& faces, const Tracer& tracer, const SolverSettings& settings) {
  assert(!s.frozen);
  Stopwatch watch;
  find_direct_of(s, find_shadow_edges(s, faces), faces, tracer, final_rays(settings), settings);
  s.seconds.trace += watch.read();
  s.views = {};
  s.fresh = {};
  s.element_vertices = make_vertices(s.elements, s.frames, s.joints);
  for (size_t row = 0; row < s.elements.size(); ++row)
    s.elements.radiosity[row] = s.elements.unshot[row] = faces.emission[s.elements.face[row]];
  for (size_t p = 0; p < s.patches.size(); ++p)
    s.patches.radiosity[p] = s.patches.unshot[p] = faces.emission[s.patches.face[p]];
  s.irradiance.assign(s.patches.size(), Rgb(0));
  s.irradiance_added.assign(s.patches.size(), Rgb(0));
  s.frozen = true;
  s.seconds.split += watch.read();
}

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
  } else if (report.pass == 2) {
    const SourceTable sources = make_sources(s.elements, faces, s.frames, s.elements.unshot, kSourceCount);
    const uint64_t aimed =
        gather_elements(s.irradiance_added, rows, {s.elements, s.element_first}, s.elements.unshot, sources);
    s.transport_ray_count += aimed;
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
  for (size_t row = 0; row < s.elements.size(); ++row) {
    report.added_power +=
        double{s.elements.area[row]} * s.elements.exposed[row] * DRgb(s.elements.unshot[row]);
    report.added_largest = std::max(report.added_largest, largest(s.elements.unshot[row]));
  }
  report.seconds = watch.read();
  s.seconds.solve += report.seconds;
  return s.passes.emplace_back(report);
}

bool is_converged(const Solution& s, const SolverSettings& settings) {
  if (s.passes.empty()) return false;
  const PassReport &first = s.passes.front(), &last = s.passes.back();
  if (last.added_largest == 0) return true;
  const auto sum = [](const DRgb& power) { return power.r + power.g + power.b; };
  return static_cast<double>(last.added_largest) <
             settings.until * static_cast<double>(first.added_largest) &&
         sum(last.added_power) < settings.until * sum(first.added_power);
}

std::vector<Rgb> vertex_radiosity(const Solution& s, const FaceTable& faces) {
  assert(s.frozen);
  return find_vertex_radiosity(s, faces, s.element_vertices, s.irradiance, !s.passes.empty());
}

std::vector<Rgb> vertex_radiosity_forecast(const Solution& s, const FaceTable& faces) {
  assert(s.frozen);
  return find_vertex_radiosity(s, faces, s.element_vertices, s.coarse, true);
}

std::vector<Rgb> element_irradiance(const Solution& s) {
  std::vector<Rgb> irradiance = s.passes.empty() ? std::vector<Rgb>(s.elements.size(), Rgb(0)) : s.direct;
  for_element_values(s, s.irradiance, all_rows(s.elements.size()),
                     [&](uint32_t row, Rgb received) { irradiance[row] += received; });
  return irradiance;
}

uint64_t find_solution_hash(const Solution& s) {
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, over 32-bit words
  for (const Rgb& value : s.elements.radiosity)
    for (int k = 0; k < 3; ++k) hash = (hash ^ std::bit_cast<uint32_t>(value[k])) * 0x100000001b3ull;
  return hash;
}

uint64_t count_starting_patches(const FaceTable& faces, const SolverSettings& settings) {
  const FaceFrameTable frames = make_face_frames(faces);
  return count_leaves_at_start(faces, frames, find_patch_sizes(faces, frames, settings).start);
}

uint64_t forecast_bytes(const FaceTable& faces, const SolverSettings& settings) {
  // Bytes a row, from tables.h; the largest moment is a split, when the elements exist twice, or the making
  // of the shared corners.
  constexpr uint64_t kFaceBytes = 700, kElementBytes = 190, kPatchBytes = 200;
  const uint64_t start = count_starting_patches(faces, settings);
  const uint64_t elements = std::max(start, settings.patch_count_max);
  const uint64_t patches = count_transport_patches(faces, settings);
  const uint64_t row_bytes = settings.keep_rows ? 8 * uint64_t{make_row_grid(settings.rays).ray_count()} : 0;
  return kFaceBytes * faces.size() + kElementBytes * elements + (kPatchBytes + row_bytes) * patches;
}

uint64_t count_bytes(const Solution& s) {
  const auto bytes = [](const auto&... column) {
    return ((column.capacity() * sizeof(column[0])) + ... + 0);
  };
  const auto patch_bytes = [&](const PatchTable& t) {
    return bytes(t.face, t.cell, t.level, t.area, t.exposed, t.radiosity, t.unshot, t.face_first);
  };
  const auto vertex_bytes = [&](const VertexTable& t) {
    return bytes(t.leaf_vertex, t.vertex_first, t.vertex_leaf, t.hanging_between, t.hanging_order, t.border);
  };
  const FaceFrameTable& f = s.frames;
  return bytes(f.origin, f.edge_u, f.edge_v, f.twist, f.dual_u, f.dual_v, f.triangle, f.affine, s.links.edge,
               s.links.corner, s.joints.edge, s.joints.corner, s.element_first, s.element_patch,
               s.aims.list_of, s.aims.list_first, s.aims.lamp, s.receivers.first, s.receivers.patch,
               s.receivers.area_until, s.receivers.centre, s.receivers.normal, s.receivers.receiver_of,
               s.views.seen, s.views.hidden, s.views.settled, s.hits.patch, s.hits.cell, s.hits.nothing,
               s.hits.back, s.hits.buried, s.direct, s.direct_error, s.irradiance, s.irradiance_added,
               s.coarse, s.coarse_error, s.fresh) +
         patch_bytes(s.patches) + patch_bytes(s.elements) + vertex_bytes(s.patch_vertices) +
         vertex_bytes(s.element_vertices);
}

}  // namespace patchlight
