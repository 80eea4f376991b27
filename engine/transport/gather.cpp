// What was sent to what is received.
#include "engine/transport/gather.h"

#include "engine/base/parallel.h"
#include "engine/mesh/buried.h"
#include "engine/mesh/quadtree.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>

namespace patchlight {
namespace {

constexpr uint32_t kBlock = 16;  // receivers
// Rays of a row for one that is aimed: few sources carry most of what is aimed at, and rows help with all of
// it.
constexpr uint32_t kRowRaysPerAimed = 4;
// A density that no other comes near, and whose square is finite.
constexpr float kWithin = 1e15f;

uint32_t find_element(const Elements& elements, uint32_t patch, uint32_t cell) {
  return find_leaf_between(elements.table, elements.first[patch], elements.first[patch + 1], cell);
}

// How a patch shares its aimed rays among the sources: by an estimate of what each sends it.
struct AimShares {
  std::vector<float> share;       // sums to 1
  std::vector<float> cumulative;  // the last is 1
  bool any = false;
};

// Shares of any sum to shares of 1.
void scale_shares(AimShares& shares) {
  float sum = 0;
  for (size_t s = 0; s < shares.share.size(); ++s) shares.cumulative[s] = sum += shares.share[s];
  shares.any = sum > 0;
  if (!shares.any) return;
  // Far sources may send so little that 1 / sum would be infinite.
  for (float& share : shares.share) share /= sum;
  for (float& cumulative : shares.cumulative) cumulative /= sum;
  shares.cumulative.back() = 1;
}

void find_shares(AimShares& shares, const SourceTable& sources, Vec3 point, Vec3 normal) {
  const size_t count = sources.size();
  shares.share.resize(count);
  shares.cumulative.resize(count);
  float* share = shares.share.data();
  for (size_t s = 0; s < count; ++s) {
    const float x = sources.x[s] - point.x, y = sources.y[s] - point.y, z = sources.z[s] - point.z;
    const float squared = x * x + y * y + z * z;
    const float cosine = std::max(x * normal.x + y * normal.y + z * normal.z, 0.0f);
    const float sent =
        std::max(-(x * sources.normal_x[s] + y * sources.normal_y[s] + z * sources.normal_z[s]), 0.0f);
    // A source that is near is wide in the sky: its strength is bounded by its own size.
    const float bounded = std::max(squared, sources.area[s]);
    share[s] = sources.share[s] * cosine * sent / (bounded * bounded);
  }
  scale_shares(shares);
}

// Power heuristic: the weight of a sample drawn with density `own` against the other way to draw it, as if
// both ways had as many: an aimed ray is worth several of a row's, for aimed ones are spread more evenly over
// what they see (measured: weighing by their numbers leaves 4 % more error in the sun room).
float heuristic(float own, float other) {
  if (own <= 0) return 0;  // dark places may have no density either way
  // Squares of densities a million million times as large as others would not fit.
  const float ratio = other / own;
  return 1 / (1 + ratio * ratio);
}

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

// A receiver, and what its rays need of it.
struct Place {
  uint32_t row;
  uint32_t patch;  // its first
  bool shared;     // has others
  CellFrame cell;  // of its first patch
  Vec3 centre, normal;
  float radius;    // of a ball about the centre that holds it
  uint32_t rays;   // of its row
  uint32_t aimed;  // rays at sources; half as many more find out which of these its block sees
  float share_valid;
};

float find_radius(uint32_t row, const Rows& rows) {
  const ReceiverTable& receivers = rows.by.receivers;
  float radius = 0;
  for (uint32_t k = receivers.first[row]; k < receivers.first[row + 1]; ++k) {
    const uint32_t p = receivers.patch[k];
    for (const Vec3& corner : cell_corners(rows.by.surfaces.frames, rows.by.patches.face[p],
                                           rows.by.patches.cell[p], rows.by.patches.level[p]))
      radius = std::max(radius, distance(corner, receivers.centre[row]));
  }
  return radius;
}

Place make_place(uint32_t row, const Rows& rows) {
  const ReceiverTable& receivers = rows.by.receivers;
  const PatchTable& patches = rows.by.patches;
  const uint32_t patch = receivers.patch[receivers.first[row]], ray_count = rows.hits.ray_count;
  return {row,
          patch,
          receivers.first[row + 1] - receivers.first[row] > 1,
          make_cell_frame(rows.by.surfaces.frames.triangle[patches.face[patch]], patches.cell[patch],
                          patches.level[patch]),
          receivers.centre[row],
          receivers.normal[row],
          find_radius(row, rows),
          ray_count,
          std::max(ray_count / kRowRaysPerAimed / kPacketSize, 1u) * kPacketSize,
          static_cast<float>(rows.hits.valid_count(row)) / static_cast<float>(ray_count)};
}

// What a bounce reads; nothing in it changes while it runs.
struct Bounce {
  const Rows& rows;
  const Elements& elements;
  std::span<const Rgb> sent;  // a row an element
  const SourceTable& sources;
};

Origin find_origin_of(const Place& place, const Bounce& b, Vec2 sample) {
  const Rows& rows = b.rows;
  if (place.shared) return find_origin(rows.by, place.row, sample);
  const uint32_t face = rows.by.patches.face[place.patch];
  return {face_point(rows.by.surfaces.frames, face,
                     cell_sample(rows.by.surfaces.frames.triangle[face], place.cell, sample)),
          place.normal};
}

// The kernel cos cos / (pi r2) between two points.
float form_factor_kernel(Vec3 way, Vec3 normal, Vec3 source_normal) {
  const float squared = dot(way, way);
  return std::max(dot(way, normal), 0.0f) * std::max(-dot(way, source_normal), 0.0f) /
         (kPi * std::max(squared * squared, 1e-30f));
}

// The density of a row's rays at a target, as the heuristic takes it: one for all points that a ray may start
// from, since weights need only sum to one. It is about the largest that any of them has: beside a patch that
// touches a bright one, aimed rays between near points would weigh without bound, and are left to the row.
float find_row_density(const Place& place, Vec3 target, Vec3 source_normal) {
  const Vec3 way = target - place.centre;
  const float kernel = form_factor_kernel(way, place.normal, source_normal);
  const float squared = dot(way, way), nearest = std::sqrt(squared) - place.radius;
  return nearest > 0 ? std::min(kernel * squared / (nearest * nearest), kWithin) : kWithin;
}

// Points on a source are picked with a density proportional to what is sent from there: per area, once the
// source is chosen. What lies in a node is rarely lit evenly.
float find_density(const SourceTable& sources, uint32_t source, const PatchTable& elements, uint32_t element,
                   std::span<const Rgb> sent) {
  return static_cast<float>(luminance(sent[element]) * elements.exposed[element] / sources.flux[source]);
}

struct SourcePoint {
  uint32_t element;
  Vec3 place;
};

SourcePoint pick_source_point(const SourceTable& sources, const PatchTable& elements,
                              const FaceFrameTable& frames, uint32_t source, Vec2 sample) {
  // The first coordinate picks the element by its flux; what is left of it is uniform again.
  const double* flux = sources.flux_before.data();
  const uint32_t first = sources.element_first[source], last = sources.element_last[source];
  const double at = flux[first] + double{sample.x} * (flux[last] - flux[first]);
  const auto k = static_cast<uint32_t>(sample.x * static_cast<float>(last - first));
  uint32_t element = sources.guide[first + std::min(k, last - first - 1)];
  while (element + 1 < last && flux[element + 1] <= at) ++element;
  const double width = flux[element + 1] - flux[element];
  const auto rest = static_cast<float>(width > 0 ? (at - flux[element]) / width : 0.5);
  const uint32_t face = sources.face[source];
  const bool triangle = frames.triangle[face];
  const CellFrame cell = make_cell_frame(triangle, elements.cell[element], elements.level[element]);
  return {element,
          face_point(frames, face,
                     cell_sample(triangle, cell, {std::clamp(rest, 0.0f, 0x1.fffffep-1f), sample.y}))};
}

// Sixteen rays aimed from a patch at its sources, samples index .. index + 15 of place.aimed.
struct AimedPacket {
  RayPacket rays;
  uint32_t source[kPacketSize], element[kPacketSize];
  float value[kPacketSize];  // what the target's radiosity counts for if it is seen; 0: no ray
};

void make_aimed_packet(AimedPacket& packet, const Place& place, const AimShares& shares, const Bounce& b,
                       uint64_t key, uint32_t index) {
  const uint32_t count = place.aimed;
  const SourceTable& sources = b.sources;
  const float first = (static_cast<float>(index) + make_jitter(key, index).x) / static_cast<float>(count);
  auto source =
      static_cast<uint32_t>(std::lower_bound(shares.cumulative.begin(), shares.cumulative.end(), first) -
                            shares.cumulative.begin());
  for (uint32_t k = 0; k < kPacketSize; ++k) {
    const float at =
        (static_cast<float>(index + k) + make_jitter(key, index + k).x) / static_cast<float>(count);
    while (shares.cumulative[source] < at) ++source;
    const AimedSample sample = make_aimed_sample(key, index + k);
    const SourcePoint point =
        pick_source_point(sources, b.elements.table, b.rows.by.surfaces.frames, source, sample.target);
    const Origin from = find_origin_of(place, b, sample.origin);
    const Vec3 origin = from.point + ray_offset(from.point) * from.normal;
    Vec3 target = point.place;
    const float kernel = form_factor_kernel(target - origin, from.normal, sources.normal[source]);
    const float density =
        shares.share[source] * find_density(sources, source, b.elements.table, point.element, b.sent);
    const float row_density = find_row_density(place, target, sources.normal[source]);
    packet.value[k] = kernel > 0 && density > 0 ? kernel / density * heuristic(density, row_density) : 0;
    packet.source[k] = source;
    packet.element[k] = point.element;
    target += ray_offset(origin, target) * sources.normal[source];
    const Vec3 way = target - origin;
    RayPacket& rays = packet.rays;
    rays.origin_x[k] = origin.x, rays.origin_y[k] = origin.y, rays.origin_z[k] = origin.z;
    rays.direction_x[k] = way.x, rays.direction_y[k] = way.y, rays.direction_z[k] = way.z;
    rays.near_distance[k] = 0, rays.far_distance[k] = 1;
  }
}

uint32_t find_worthwhile(const AimedPacket& packet) { return find_positive(packet.value); }

// How often rays from a block of receivers reach each source: what blocks one's view mostly blocks its
// neighbours'.
struct SourceViews {
  std::vector<uint32_t> tried, reached;  // rows are sources
  void clear(size_t count) { tried.assign(count, 0), reached.assign(count, 0); }
};

uint64_t make_place_key(const Place& place, const Bounce& b, uint32_t purpose) {
  const PatchTable& patches = b.rows.by.patches;
  const uint32_t patch = place.patch;
  return make_ray_key(b.rows.by.seed, patches.face[patch], patches.cell[patch], patches.level[patch],
                      purpose);
}

uint64_t probe_sources(SourceViews& views, const Place& place, const AimShares& shares, const Bounce& b) {
  const uint64_t key = make_place_key(place, b, kAimedProbeRays);
  uint64_t ray_count = 0;
  AimedPacket packet;
  // Neighbours take turns: each every other packet, which hold different sources.
  const uint32_t first = place.aimed > kPacketSize ? place.row % 2 * kPacketSize : 0;
  for (uint32_t index = first; index < place.aimed; index += 2 * kPacketSize) {
    make_aimed_packet(packet, place, shares, b, key, index);
    const uint32_t active = find_worthwhile(packet);
    if (!active) continue;
    ray_count += static_cast<uint64_t>(std::popcount(active));
    const uint32_t blocked =
        find_blocked(b.rows.by.surfaces.tracer, packet.rays, active, RayOrder::kIncoherent);
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      views.tried[packet.source[k]] += active >> k & 1u;
      views.reached[packet.source[k]] += (active & ~blocked) >> k & 1u;
    }
  }
  return ray_count;
}

// Sources that the block hardly sees get fewer rays, but never none: the result stays unbiased.
void weigh_shares(AimShares& shares, const SourceViews& views) {
  constexpr float kLeast = 0.05f;
  for (size_t s = 0; s < shares.share.size(); ++s) {
    const float seen =
        (static_cast<float>(views.reached[s]) + 0.5f) / (static_cast<float>(views.tried[s]) + 1.0f);
    shares.share[s] *= std::max(seen, kLeast);
  }
  scale_shares(shares);
}

// What two halves of some rays give; each half estimates half of the whole.
struct Halves {
  Rgb half[2] = {Rgb(0), Rgb(0)};
  Rgb sum() const { return half[0] + half[1]; }
  Rgb difference() const { return half[0] - half[1]; }
  void operator*=(float factor) { half[0] *= factor, half[1] *= factor; }
};

// The part of the aimed rays; the mean over their count.
Halves gather_aimed(const Place& place, const AimShares& shares, const Bounce& b, uint64_t& ray_count) {
  const uint64_t key = make_place_key(place, b, kAimedRays);
  const Frame frame = make_frame(place.normal);
  Halves sum;
  uint32_t usable_count = 0;
  AimedPacket packet;
  for (uint32_t index = 0; index < place.aimed; index += kPacketSize) {
    make_aimed_packet(packet, place, shares, b, key, index);
    const uint32_t buried =
        place.share_valid < 1 ? find_buried(b.rows.by.surfaces, frame, packet.rays, 0xffff) : 0;
    usable_count += kPacketSize - static_cast<uint32_t>(std::popcount(buried));
    const uint32_t active = find_worthwhile(packet) & ~buried;
    if (!active) continue;
    ray_count += static_cast<uint64_t>(std::popcount(active));
    const uint32_t blocked =
        find_blocked(b.rows.by.surfaces.tracer, packet.rays, active, RayOrder::kIncoherent);
    for (uint32_t k = 0; k < kPacketSize; ++k)
      // Consecutive samples go to one source.
      if ((active & ~blocked) >> k & 1u) sum.half[k & 1] += packet.value[k] * b.sent[packet.element[k]];
  }
  sum *= usable_count ? 1 / static_cast<float>(usable_count) : 0;
  return sum;
}

// The part of the row's own rays; hits on sources weigh as much as the aimed rays leave them.
Halves gather_row(const Place& place, const AimShares& shares, const Bounce& b,
                  std::span<const uint32_t> element_source, RowScratch& scratch) {
  const RowHits hits = find_row(scratch, b.rows, place.row);
  const FaceFrameTable& frames = b.rows.by.surfaces.frames;
  Halves sum;
  for (size_t k = 0; k < place.rays; ++k) {
    const uint32_t patch = hits.patch[k];
    if (patch >= kHitBuried) continue;
    const uint32_t element = find_element(b.elements, patch, hits.cell[k]);
    const uint32_t source = shares.any ? element_source[element] : kNone;
    float weight = 1;
    if (source != kNone && shares.share[source] > 0) {
      const uint32_t face = b.rows.by.patches.face[patch];
      const CellFrame end = make_cell_frame(frames.triangle[face], hits.cell[k], kLevelMax);
      const Vec2 uv = end.origin + end.size * 0.5f;
      const float row_density =
          find_row_density(place, face_point(frames, face, uv), b.sources.normal[source]);
      const float density =
          shares.share[source] * find_density(b.sources, source, b.elements.table, element, b.sent);
      weight = heuristic(row_density, density);
    }
    sum.half[find_half(k)] += weight * b.sent[element];
  }
  sum *= 1 / (place.share_valid * static_cast<float>(place.rays));
  return sum;
}

// Blocks of neighbours that face one way share what they learn of the sources: on one face, or in one run of
// shared receivers.
std::vector<uint32_t> make_blocks(const ReceiverTable& receivers, const PatchTable& patches) {
  const auto is_shared = [&](uint32_t row) { return receivers.first[row + 1] - receivers.first[row] > 1; };
  const auto face_of = [&](uint32_t row) { return patches.face[receivers.patch[receivers.first[row]]]; };
  std::vector<uint32_t> block_first;
  for (uint32_t row = 0; row < receivers.size(); ++row) {
    const bool goes_on =
        row > 0 && row - block_first.back() < kBlock &&
        (is_shared(row)
             ? is_shared(row - 1) && dot(receivers.normal[row], receivers.normal[block_first.back()]) > 0.9f
             : face_of(row) == face_of(row - 1));
    if (!goes_on) block_first.push_back(row);
  }
  block_first.push_back(static_cast<uint32_t>(receivers.size()));
  return block_first;
}

// The value of a receiver to all of its patches.
void spread(std::span<Rgb> column, const ReceiverTable& receivers, size_t row, Rgb value) {
  for (uint32_t k = receivers.first[row]; k < receivers.first[row + 1]; ++k)
    column[receivers.patch[k]] = value;
}

}  // namespace

void gather_emission(std::span<Rgb> irradiance, std::span<Rgb> noise, const Rows& rows,
                     std::span<const float> emission_by_rows) {
  const FaceTable& faces = rows.by.surfaces.faces;
  // Few patches emit: a number a patch stays in the cache.
  std::vector<float> emits(rows.by.patches.size());
  for (size_t p = 0; p < emits.size(); ++p) emits[p] = luminance(faces.emission[rows.by.patches.face[p]]);
  for_rows(rows.by.receivers.size(), 64, [&](size_t begin, size_t end) {
    RowScratch scratch;
    for (uint32_t row = static_cast<uint32_t>(begin); row < end; ++row) {
      Halves sum;
      // Polygons that share a receiver aim alike.
      const uint32_t own = rows.by.receivers.patch[rows.by.receivers.first[row]];
      const uint32_t polygon = faces.polygon[rows.by.patches.face[own]];
      if (const float by_rows = emission_by_rows[polygon]; by_rows > 0) {
        const std::span<const uint32_t> hit = find_row(scratch, rows, row).patch;
        for (size_t k = 0; k < hit.size(); ++k)
          if (hit[k] < kHitBuried && emits[hit[k]] > 0 && emits[hit[k]] <= by_rows)
            sum.half[find_half(k)] += faces.emission[rows.by.patches.face[hit[k]]];
      }
      const uint32_t valid = rows.hits.valid_count(row);
      sum *= valid ? 1 / static_cast<float>(valid) : 0;
      spread(irradiance, rows.by.receivers, row, sum.sum());
      if (!noise.empty()) spread(noise, rows.by.receivers, row, sum.difference());
    }
  });
}

void gather_patches(std::span<Rgb> irradiance, std::span<Rgb> noise, const Rows& rows,
                    std::span<const Rgb> sent) {
  // Four floats a patch load in one go; the last row stands for rays that met no patch.
  struct alignas(16) Wide {
    float channel[4];
  };
  std::vector<Wide> source(sent.size() + 1, Wide{});
  for (size_t p = 0; p < sent.size(); ++p) source[p] = {{sent[p].r, sent[p].g, sent[p].b, 0}};
  const auto no_patch = static_cast<uint32_t>(sent.size());
  for_rows(rows.by.receivers.size(), 64, [&](size_t begin, size_t end) {
    RowScratch scratch;
    for (uint32_t row = static_cast<uint32_t>(begin); row < end; ++row) {
      const std::span<const uint32_t> hit = find_row(scratch, rows, row).patch;
      // Halves as find_half() has them, eight at once.
      Wide sum[2] = {};
      for (size_t k = 0; k < hit.size(); k += 8)
        for (const auto& [even, odd] : {std::pair{0u, 1u}, {2u, 3u}, {5u, 4u}, {7u, 6u}}) {
          const Wide& a = source[std::min(hit[k + even], no_patch)];
          const Wide& b = source[std::min(hit[k + odd], no_patch)];
          for (int c = 0; c < 4; ++c) sum[0].channel[c] += a.channel[c], sum[1].channel[c] += b.channel[c];
        }
      const auto valid = static_cast<float>(rows.hits.valid_count(row));
      const Rgb halves[2] = {{sum[0].channel[0], sum[0].channel[1], sum[0].channel[2]},
                             {sum[1].channel[0], sum[1].channel[1], sum[1].channel[2]}};
      spread(irradiance, rows.by.receivers, row, valid > 0 ? (halves[0] + halves[1]) / valid : Rgb(0));
      if (!noise.empty())
        spread(noise, rows.by.receivers, row, valid > 0 ? (halves[0] - halves[1]) / valid : Rgb(0));
    }
  });
}

uint64_t gather_elements(std::span<Rgb> irradiance, std::span<Rgb> noise, const Rows& rows,
                         const Elements& elements, std::span<const Rgb> sent, const SourceTable& sources,
                         std::span<const uint8_t> asked) {
  const auto is_asked = [&](uint32_t row) { return asked.empty() || asked[row]; };
  const Bounce b{rows, elements, sent, sources};
  std::vector<uint32_t> element_source(elements.table.size(), kNone);
  for (uint32_t s = 0; s < sources.size(); ++s)
    std::fill(element_source.begin() + sources.element_first[s],
              element_source.begin() + sources.element_last[s], s);
  assert(rows.hits.ray_count % kPacketSize == 0);
  const std::vector<uint32_t> block_first = make_blocks(rows.by.receivers, rows.by.patches);
  std::atomic<uint64_t> ray_count{0};
  for_rows(block_first.size() - 1, 2, [&](size_t begin, size_t end) {
    std::vector<AimShares> shares(kBlock);
    SourceViews views;
    RowScratch scratch;
    uint64_t cast = 0;
    for (size_t block = begin; block < end; ++block) {
      views.clear(sources.size());
      for (uint32_t row = block_first[block]; row < block_first[block + 1]; ++row) {
        if (!is_asked(row)) continue;
        const Place place = make_place(row, rows);
        AimShares& mine = shares[row - block_first[block]];
        find_shares(mine, sources, place.centre, place.normal);
        if (mine.any && place.share_valid > 0) cast += probe_sources(views, place, mine, b);
      }
      for (uint32_t row = block_first[block]; row < block_first[block + 1]; ++row) {
        if (!is_asked(row)) continue;
        const Place place = make_place(row, rows);
        AimShares& mine = shares[row - block_first[block]];
        Rgb received(0), difference(0);
        if (place.share_valid > 0) {
          if (mine.any) weigh_shares(mine, views);
          const Halves by_row = gather_row(place, mine, b, element_source, scratch);
          const Halves aimed = mine.any ? gather_aimed(place, mine, b, cast) : Halves{};
          received = by_row.sum() + aimed.sum();
          difference = by_row.difference() + aimed.difference();
        }
        spread(irradiance, rows.by.receivers, row, received);
        if (!noise.empty()) spread(noise, rows.by.receivers, row, difference);
      }
    }
    ray_count += cast;
  });
  return ray_count;
}

}  // namespace patchlight
