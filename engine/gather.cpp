// What was sent to what is received.
#include "gather.h"

#include "direct.h"
#include "parallel.h"
#include "quadtree.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <queue>

namespace patchlight {
namespace {

// Only places that send more than this many times the scene's mean are aimed at: elsewhere rows do as well,
// and where all send alike they are exact.
constexpr double kBrightOverMean = 2;

uint32_t valid_count(const HitTable& hits, size_t row) {
  const auto first = hits.patch.begin() + static_cast<std::ptrdiff_t>(row * hits.ray_count);
  return hits.ray_count - static_cast<uint32_t>(std::count(first, first + hits.ray_count, kHitBuried));
}

uint32_t find_element(const Elements& elements, uint32_t patch, uint32_t cell) {
  uint32_t low = elements.first[patch], high = elements.first[patch + 1];
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    (elements.table.cell[middle] <= cell ? low : high) = middle;
  }
  return low;
}

// Area of the source for each unit of its own parameters, at (u, v) of its face.
float area_density(const SourceTable& sources, const FaceFrameTable& frames, uint32_t source, Vec2 uv) {
  const uint32_t face = sources.face[source], level = sources.level[source];
  if (frames.affine[face]) return sources.area[source];
  const Vec3 u = frames.edge_u[face] + uv.y * frames.twist[face],
             v = frames.edge_v[face] + uv.x * frames.twist[face];
  return length(cross(u, v)) * cell_size(level) * cell_size(level);
}

// How a patch shares its aimed rays among the sources: by an estimate of what each sends it.
struct AimShares {
  std::vector<float> share;       // sums to 1
  std::vector<float> cumulative;  // the last is 1
  bool any = false;
};

void find_shares(AimShares& shares, const SourceTable& sources, Vec3 point, Vec3 normal) {
  const size_t count = sources.size();
  shares.share.resize(count);
  shares.cumulative.resize(count);
  for (size_t s = 0; s < count; ++s) {
    const Vec3 way = sources.centre[s] - point;
    const float squared = dot(way, way);
    const float cosines = std::max(dot(way, normal), 0.0f) * std::max(-dot(way, sources.normal[s]), 0.0f);
    // A source that is near is wide in the sky: its strength is bounded by its own size.
    const float bounded = std::max(squared, sources.area[s]);
    shares.share[s] = sources.share[s] * cosines / (bounded * bounded);
  }
  float sum = 0;
  for (size_t s = 0; s < count; ++s) shares.cumulative[s] = sum += shares.share[s];
  shares.any = sum > 0;
  if (!shares.any) return;
  for (size_t s = 0; s < count; ++s) shares.share[s] /= sum, shares.cumulative[s] /= sum;
  shares.cumulative.back() = 1;
}

// Power heuristic: the weight of a sample drawn with density `own` against the other way to draw it. Both
// ways take the densities from the patch's centre, whatever point of it a ray starts from: weights need only
// sum to one.
float heuristic(float own, float other) { return own * own / (own * own + other * other); }

// A sequence that fills four dimensions evenly (Roberts: The Unreasonable Effectiveness of Quasirandom
// Sequences, 2018): consecutive samples, which go to one source or to neighbours, cover origin and target
// evenly.
struct AimedSample {
  Vec2 origin, target;
};
AimedSample make_aimed_sample(uint64_t key, uint32_t index) {
  constexpr uint32_t kStep[4] = {3679390609u, 3152041523u, 2700274806u,
                                 2313257605u};  // 2^32 / g^k, g^5 = g + 1
  const uint64_t more = mix_bits(key);
  const uint32_t start[4] = {static_cast<uint32_t>(key), static_cast<uint32_t>(key >> 32),
                             static_cast<uint32_t>(more), static_cast<uint32_t>(more >> 32)};
  const auto coordinate = [&](int k) {
    return static_cast<float>((start[k] + kStep[k] * index) >> 8) * 0x1p-24f;
  };
  return {{coordinate(0), coordinate(1)}, {coordinate(2), coordinate(3)}};
}

struct PatchPlace {
  uint32_t row, face, cell, level;
  Vec3 centre, normal;
  uint32_t rays;  // of its row, and as many aimed
  float share_valid;
};

// The kernel cos cos / (pi r2) between two points.
float form_factor_kernel(Vec3 way, Vec3 normal, Vec3 source_normal) {
  const float squared = dot(way, way);
  return std::max(dot(way, normal), 0.0f) * std::max(-dot(way, source_normal), 0.0f) /
         (kPi * std::max(squared * squared, 1e-30f));
}

// The part of the aimed rays; the mean over their count.
Rgb gather_aimed(const PatchPlace& place, const AimShares& shares, const SourceTable& sources,
                 const Elements& elements, std::span<const Rgb> sent, const FaceTable& faces,
                 const FaceFrameTable& frames, const Tracer& tracer, uint64_t seed, uint64_t& ray_count) {
  const uint64_t key = make_row_key(seed, place.face, place.cell, place.level, kRowAimed);
  const bool triangle = frames.triangle[place.face];
  const CellFrame cell = make_cell_frame(triangle, place.cell, place.level);
  const Frame frame = make_frame(place.normal);
  Rgb sum(0);
  uint32_t source = 0, usable_count = 0;
  RayPacket rays;
  for (uint32_t index = 0; index < place.rays; index += kPacketSize) {
    float value[kPacketSize];
    uint32_t target_element[kPacketSize], active = 0;
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const float at =
          (static_cast<float>(index + k) + make_jitter(key, index + k).x) / static_cast<float>(place.rays);
      while (shares.cumulative[source] < at) ++source;
      const AimedSample sample = make_aimed_sample(key, index + k);
      const uint32_t face = sources.face[source];
      const bool source_triangle = frames.triangle[face];
      const Vec2 uv = cell_sample(
          source_triangle, make_cell_frame(source_triangle, sources.cell[source], sources.level[source]),
          sample.target);
      Vec3 origin = face_point(frames, place.face, cell_sample(triangle, cell, sample.origin));
      origin += ray_offset(origin) * place.normal;
      Vec3 target = face_point(frames, face, uv);
      const float kernel = form_factor_kernel(target - origin, place.normal, sources.normal[source]);
      const float density = shares.share[source] / area_density(sources, frames, source, uv);
      const float row_density =
          form_factor_kernel(target - place.centre, place.normal, sources.normal[source]);
      value[k] = kernel > 0 && density > 0 ? kernel / density * heuristic(density, row_density) : 0;
      if (value[k] > 0) active |= 1u << k;
      // The element under the target: a search in the node's rows.
      const uint32_t code = find_cell(source_triangle, uv);
      const auto rows_begin = elements.table.cell.begin() + sources.element_first[source];
      const auto rows_end = elements.table.cell.begin() + sources.element_last[source];
      target_element[k] =
          static_cast<uint32_t>(std::upper_bound(rows_begin, rows_end, code) - elements.table.cell.begin()) -
          1;
      target += ray_offset(target) * sources.normal[source];
      const Vec3 way = target - origin;
      rays.origin_x[k] = origin.x, rays.origin_y[k] = origin.y, rays.origin_z[k] = origin.z;
      rays.direction_x[k] = way.x, rays.direction_y[k] = way.y, rays.direction_z[k] = way.z;
      rays.near_distance[k] = 0, rays.far_distance[k] = 1;
    }
    const uint32_t buried = place.share_valid < 1 ? find_buried(tracer, faces, frame, rays, 0xffff) : 0;
    usable_count += kPacketSize - static_cast<uint32_t>(std::popcount(buried));
    active &= ~buried;
    if (!active) continue;
    ray_count += static_cast<uint64_t>(std::popcount(active));
    const uint32_t blocked = find_blocked(tracer, rays, active);
    for (uint32_t k = 0; k < kPacketSize; ++k)
      if ((active & ~blocked) >> k & 1u) sum += value[k] * sent[target_element[k]];
  }
  return usable_count ? sum / static_cast<float>(usable_count) : Rgb(0);
}

// The part of the row's own rays; hits on sources weigh as much as the aimed rays leave them.
Rgb gather_row(const PatchPlace& place, const AimShares& shares, const SourceTable& sources,
               const HitTable& hits, const PatchTable& patches, const Elements& elements,
               std::span<const uint32_t> element_source, std::span<const Rgb> sent,
               const FaceFrameTable& frames) {
  Rgb sum(0);
  for (size_t entry = place.row * size_t{hits.ray_count}; entry < (place.row + 1) * size_t{hits.ray_count};
       ++entry) {
    const uint32_t patch = hits.patch[entry];
    if (patch >= kHitBuried) continue;
    const uint32_t element = find_element(elements, patch, hits.cell[entry]);
    const uint32_t source = shares.any ? element_source[element] : kNone;
    float weight = 1;
    if (source != kNone && shares.share[source] > 0) {
      const uint32_t face = patches.face[patch];
      const CellFrame end = make_cell_frame(frames.triangle[face], hits.cell[entry], kLevelMax);
      const Vec2 uv = end.origin + end.size * 0.5f;
      const float kernel = form_factor_kernel(face_point(frames, face, uv) - place.centre, place.normal,
                                              sources.normal[source]);
      weight = heuristic(kernel, shares.share[source] / area_density(sources, frames, source, uv));
    }
    sum += weight * sent[element];
  }
  return sum / (place.share_valid * static_cast<float>(hits.ray_count));
}

}  // namespace

void gather_emission(std::span<Rgb> irradiance, const HitTable& hits, const AimTable& aims,
                     const PatchTable& patches, const FaceTable& faces) {
  std::vector<uint8_t> emits(faces.size());
  for (size_t f = 0; f < faces.size(); ++f) emits[f] = largest(faces.emission[f]) > 0;
  for_rows(patches.size(), 64, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      Rgb sum(0);
      for (size_t k = row * hits.ray_count; k < (row + 1) * hits.ray_count; ++k) {
        if (hits.patch[k] >= kHitBuried) continue;
        const uint32_t face = patches.face[hits.patch[k]];
        if (emits[face] && !is_aimed(aims, static_cast<uint32_t>(row), face)) sum += faces.emission[face];
      }
      const uint32_t valid = valid_count(hits, row);
      irradiance[row] = valid ? sum / static_cast<float>(valid) : Rgb(0);
    }
  });
}

void gather_patches(std::span<Rgb> irradiance, std::span<Rgb> difference, const HitTable& hits,
                    std::span<const Rgb> sent) {
  // Four floats a patch load in one go; the last row stands for rays that met no patch.
  struct alignas(16) Wide {
    float channel[4];
  };
  std::vector<Wide> source(sent.size() + 1, Wide{});
  for (size_t p = 0; p < sent.size(); ++p) source[p] = {{sent[p].r, sent[p].g, sent[p].b, 0}};
  const auto no_patch = static_cast<uint32_t>(sent.size());
  for_rows(irradiance.size(), 64, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const uint32_t* hit = hits.patch.data() + row * hits.ray_count;
      // Rays in two halves, a chequerboard over the strata: k and k ^ 5 are in one, k ^ 1 and k ^ 4 in the
      // other.
      Wide sum[2] = {};
      for (uint32_t k = 0; k < hits.ray_count; k += 8)
        for (const auto& [even, odd] : {std::pair{0u, 1u}, {2u, 3u}, {5u, 4u}, {7u, 6u}}) {
          const Wide& a = source[std::min(hit[k + even], no_patch)];
          const Wide& b = source[std::min(hit[k + odd], no_patch)];
          for (int c = 0; c < 4; ++c) sum[0].channel[c] += a.channel[c], sum[1].channel[c] += b.channel[c];
        }
      const auto valid = static_cast<float>(valid_count(hits, row));
      const Rgb halves[2] = {{sum[0].channel[0], sum[0].channel[1], sum[0].channel[2]},
                             {sum[1].channel[0], sum[1].channel[1], sum[1].channel[2]}};
      irradiance[row] = valid > 0 ? (halves[0] + halves[1]) / valid : Rgb(0);
      if (!difference.empty()) difference[row] = valid > 0 ? abs(halves[0] - halves[1]) / valid : Rgb(0);
    }
  });
}

SourceTable make_sources(const PatchTable& elements, const FaceTable& faces, const FaceFrameTable& frames,
                         std::span<const Rgb> sent, uint32_t count) {
  std::vector<double> flux_before(elements.size() + 1, 0);
  double area = 0;
  for (size_t row = 0; row < elements.size(); ++row) {
    const double exposed_area = double{elements.area[row]} * elements.exposed[row];
    flux_before[row + 1] = flux_before[row] + exposed_area * luminance(sent[row]);
    if (largest(faces.reflectance[elements.face[row]]) > 0) area += exposed_area;
  }
  SourceTable sources;
  if (flux_before.back() <= 0 || area <= 0) return sources;
  struct Node {
    double flux;
    uint32_t face, cell, level, first, last;
    bool operator<(const Node& other) const {
      return flux != other.flux   ? flux < other.flux
             : face != other.face ? face > other.face
                                  : cell > other.cell;
    }
  };
  const auto make_node = [&](uint32_t face, uint32_t cell, uint32_t level, uint32_t first, uint32_t last) {
    return Node{flux_before[last] - flux_before[first], face, cell, level, first, last};
  };
  std::priority_queue<Node> queue;
  for (uint32_t f = 0; f < faces.size(); ++f)
    if (const Node root = make_node(f, 0, 0, elements.face_first[f], elements.face_first[f + 1]);
        root.flux > 0)
      queue.push(root);
  const size_t roots = queue.size();
  std::vector<Node> leaves;
  while (!queue.empty() && queue.size() + leaves.size() < roots + count) {
    const Node node = queue.top();
    queue.pop();
    if (node.last - node.first == 1) {
      leaves.push_back(node);
      continue;
    }
    uint32_t first = node.first;
    for (uint32_t child = 0; child < 4; ++child) {
      const uint32_t cell = node.cell | child << (30 - 2 * node.level);
      const uint64_t end_cell = cell + cell_span(node.level + 1);
      const auto end = std::lower_bound(elements.cell.begin() + first, elements.cell.begin() + node.last,
                                        end_cell, [](uint32_t a, uint64_t b) { return a < b; });
      const auto last = static_cast<uint32_t>(end - elements.cell.begin());
      if (const Node part = make_node(node.face, cell, node.level + 1, first, last); part.flux > 0)
        queue.push(part);
      first = last;
    }
  }
  for (; !queue.empty(); queue.pop()) leaves.push_back(queue.top());
  std::sort(leaves.begin(), leaves.end(), [](const Node& a, const Node& b) {
    return a.face != b.face ? a.face < b.face : a.cell < b.cell;
  });
  const double bright = kBrightOverMean * flux_before.back() / area;
  for (const Node& node : leaves) {
    const float node_area = cell_area(frames, node.face, node.cell, node.level);
    if (node.flux <= bright * node_area) continue;
    sources.face.push_back(node.face);
    sources.cell.push_back(node.cell);
    sources.level.push_back(static_cast<uint8_t>(node.level));
    sources.element_first.push_back(node.first);
    sources.element_last.push_back(node.last);
    sources.centre.push_back(cell_centre(frames, node.face, node.cell, node.level));
    sources.normal.push_back(faces.normal[node.face]);
    sources.area.push_back(node_area);
    sources.share.push_back(static_cast<float>(node.flux / flux_before.back()));
  }
  return sources;
}

uint64_t gather_elements(std::span<Rgb> irradiance, const HitTable& hits, const PatchTable& patches,
                         const Elements& elements, std::span<const Rgb> sent, const SourceTable& sources,
                         const FaceTable& faces, const FaceFrameTable& frames, const Tracer& tracer,
                         uint64_t seed) {
  std::vector<uint32_t> element_source(elements.table.size(), kNone);
  for (uint32_t s = 0; s < sources.size(); ++s)
    std::fill(element_source.begin() + sources.element_first[s],
              element_source.begin() + sources.element_last[s], s);
  assert(hits.ray_count % kPacketSize == 0);
  std::atomic<uint64_t> ray_count{0};
  for_rows(patches.size(), 32, [&](size_t begin, size_t end) {
    AimShares shares;
    uint64_t cast = 0;
    for (size_t row = begin; row < end; ++row) {
      const float share_valid =
          static_cast<float>(valid_count(hits, row)) / static_cast<float>(hits.ray_count);
      irradiance[row] = Rgb(0);
      if (share_valid == 0) continue;
      const uint32_t face = patches.face[row];
      const PatchPlace place{static_cast<uint32_t>(row),
                             face,
                             patches.cell[row],
                             patches.level[row],
                             cell_centre(frames, face, patches.cell[row], patches.level[row]),
                             faces.normal[face],
                             hits.ray_count,
                             share_valid};
      find_shares(shares, sources, place.centre, place.normal);
      irradiance[row] =
          gather_row(place, shares, sources, hits, patches, elements, element_source, sent, frames);
      if (shares.any)
        irradiance[row] +=
            gather_aimed(place, shares, sources, elements, sent, faces, frames, tracer, seed, cast);
    }
    ray_count += cast;
  });
  return ray_count;
}

}  // namespace patchlight
