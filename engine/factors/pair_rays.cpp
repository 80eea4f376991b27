// Stratified pairs of points to rays, rays to sums.
#include "engine/factors/pair_rays.h"

#include "engine/base/parallel.h"
#include "engine/base/spherical.h"

#include <algorithm>
#include <cassert>

namespace patchlight {
namespace {

// Polygons further apart than so many of their radii together are far: their sky hardly changes.
constexpr double kFar = 1.5;
// So many points are sorted at a time; a power of two.
constexpr uint32_t kPointsSorted = 256;

double find_area(const std::array<DVec3, 3>& c) { return 0.5 * length(cross(c[1] - c[0], c[2] - c[0])); }

// Splits [0, 1) at the shares of a list of sums; what is left of the number is uniform again.
size_t pick(std::span<const double> until, double& number) {
  const double at = number * until.back();
  const auto found = std::upper_bound(until.begin(), until.end() - 1, at);
  const auto index = static_cast<size_t>(found - until.begin());
  const double before = index == 0 ? 0 : until[index - 1], size = until[index] - before;
  number = size > 0 ? std::clamp((at - before) / size, 0.0, 1.0 - 0x1p-53) : 0;
  return index;
}

// Uniform in the area. Heitz: A Low-Distortion Map Between Triangle and Square, 2019.
DVec3 find_point(const std::array<DVec3, 3>& c, double u, double v) {
  if (v > u) {
    u *= 0.5, v -= u;
  } else {
    v *= 0.5, u -= v;
  }
  return c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
}

struct Target {
  DVec3 point;
  double weight;  // of the light that reaches it; the mean over a pair's samples is pi times its factor
};
constexpr Target kNoTarget = {DVec3(0), 0};

using Triangles = std::span<const std::array<DVec3, 3>>;

Target find_far_target(Triangles triangles, std::span<const double> area_until, DVec3 normal_to, DVec3 origin,
                       DVec3 normal, double u, double v) {
  const std::array<DVec3, 3>& triangle = triangles[pick(area_until, u)];
  const DVec3 point = find_point(triangle, u, v), way = point - origin;
  const double squared = dot(way, way), cosine = dot(way, normal), cosine_to = -dot(way, normal_to);
  if (!(cosine > 0) || !(cosine_to > 0)) return kNoTarget;
  return {point, cosine * cosine_to / (squared * squared) * area_until.back()};
}

Target find_near_target(SampleScratch& sky, Triangles triangles, DVec3 normal_to, DVec3 origin, DVec3 normal,
                        double u, double v) {
  sky.directions.clear(), sky.angle_until.clear();
  double sum = 0;
  for (const auto& c : triangles) {
    const DVec3 a = c[0] - origin, b = c[1] - origin, d = c[2] - origin;
    sky.directions.push_back({a / length(a), b / length(b), d / length(d)});
    const auto& unit = sky.directions.back();
    const double angle = find_solid_angle(unit[0], unit[1], unit[2]);
    sky.angle_until.push_back(sum += angle > 0 ? angle : 0);  // a corner in the origin: not a number
  }
  if (!(sum > 0)) return kNoTarget;
  const size_t k = pick(sky.angle_until, u);
  const double angle = sky.angle_until[k] - (k == 0 ? 0 : sky.angle_until[k - 1]);
  if (angle < kSmallSolidAngle) {
    const double area = find_area(triangles[k]);
    const Target target =
        find_far_target(triangles.subspan(k, 1), {&area, 1}, normal_to, origin, normal, u, v);
    return {target.point, target.weight * sum / angle};
  }
  const auto& unit = sky.directions[k];
  const DVec3 way = sample_spherical_triangle(unit[0], unit[1], unit[2], angle, u, v);
  const double slope = dot(way, normal_to), cosine = dot(way, normal);
  if (!(slope < 0) || !(cosine > 0)) return kNoTarget;
  return {origin + dot(triangles[k][0] - origin, normal_to) / slope * way, cosine * sum};
}

// The same rays in double precision.
struct FineEnds {
  std::array<DVec3, kPacketSize> from, to;
};

uint32_t find_blocked_fine(const FineRays& fine, const FineEnds& ends, uint32_t active) {
  uint32_t blocked = 0;
  for (uint32_t k = 0; k < kPacketSize; ++k)
    if ((active >> k & 1u) &&
        is_blocked(fine.tree, fine.faces, fine.parts, fine.part_a, fine.part_b, ends.from[k], ends.to[k]))
      blocked |= 1u << k;
  return blocked;
}

// One sample of a pair. Returns its weight, 1 in the mean; 0: it carries no light, and no ray was made.
double make_ray(RayPacket& rays, FineEnds& ends, uint32_t lane, const RayPairTable& pairs, size_t pair,
                double share, std::array<double, 4> point, SampleScratch& scratch) {
  const uint32_t begin = pairs.triangle_first[pair], middle = pairs.triangle_to[pair],
                 end = pairs.triangle_first[pair + 1];
  const auto area_from = std::span(pairs.area_until).subspan(begin, middle - begin);
  const auto area_to = std::span(pairs.area_until).subspan(middle, end - middle);
  const auto triangles_to = std::span(pairs.triangle).subspan(middle, end - middle);
  const DVec3 normal = pairs.normal_from[pair], normal_to = pairs.normal_to[pair];
  const size_t triangle = begin + pick(area_from, share);
  const DVec3 origin = find_point(pairs.triangle[triangle], share, point[1]);
  const Target target =
      pairs.far[pair]
          ? find_far_target(triangles_to, area_to, normal_to, origin, normal, point[2], point[3])
          : find_near_target(scratch, triangles_to, normal_to, origin, normal, point[2], point[3]);
  if (!(target.weight > 0)) return 0;
  ends.from[lane] = origin, ends.to[lane] = target.point;
  const Vec3 from(origin - pairs.shift), to(target.point - pairs.shift);
  const Vec3 start = from + (ray_offset(from) + pairs.off_plane) * Vec3(normal);
  const Vec3 way = to + (ray_offset(start, to) + pairs.off_plane) * Vec3(normal_to) - start;
  rays.origin_x[lane] = start.x, rays.origin_y[lane] = start.y, rays.origin_z[lane] = start.z;
  rays.direction_x[lane] = way.x, rays.direction_y[lane] = way.y, rays.direction_z[lane] = way.z;
  rays.near_distance[lane] = 0, rays.far_distance[lane] = 1;
  return target.weight * area_from.back() * pairs.exchange_inverse[pair];
}

// The next `count` points, a power of two that divides `first`, by their first number: each of as many equal
// parts of [0, 1) has one of them. So rays of one pair stand together.
void sort_points(SampleScratch& scratch, const Sobol& sobol, uint32_t first, uint32_t count,
                 uint32_t block_size) {
  static const std::array<SobolBits, kPointsSorted> kLowBits = [] {
    std::array<SobolBits, kPointsSorted> bits;
    for (uint32_t k = 0; k < kPointsSorted; ++k) bits[k] = find_sobol_bits(k);
    return bits;
  }();
  assert(first % count == 0);
  assert(count <= kPointsSorted);
  scratch.points.resize(count), scratch.block.resize(count);
  const SobolBits high = find_sobol_bits(first);
  for (uint32_t k = 0; k < count; ++k) {
    SobolBits bits = kLowBits[k];
    for (uint32_t d = 0; d < 4; ++d) bits[d] ^= high[d];
    const std::array<double, 4> point = make_point(sobol, bits);
    const auto slot = static_cast<uint32_t>(point[0] * count);
    scratch.points[slot] = point, scratch.block[slot] = (first + k) / block_size;
  }
}

// Casts the points of the scratch and adds them up.
void cast_points(PairSums& sums, const RayPairTable& pairs, const Tracer& tracer, SampleScratch& scratch) {
  RayPacket rays;
  FineEnds ends;
  std::array<double, kPacketSize> weight{};
  size_t pair = 0;
  const double exchange = pairs.exchange_until.back();
  for (size_t first = 0; first < scratch.points.size(); first += kPacketSize) {
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      const std::array<double, 4>& point = scratch.points[first + k];
      const double at = point[0] * exchange;
      while (pair + 1 < pairs.size() && at >= pairs.exchange_until[pair]) ++pair;
      // What is left of the number within the pair is uniform again.
      const double before = pair == 0 ? 0 : pairs.exchange_until[pair - 1];
      const double share = std::clamp((at - before) * pairs.exchange_inverse[pair], 0.0, 1 - 0x1p-53);
      weight[k] = make_ray(rays, ends, k, pairs, pair, share, point, scratch);
    }
    const uint32_t active = find_positive(weight);
    if (active == 0) continue;
    const uint32_t blocked = pairs.fine ? find_blocked_fine(*pairs.fine, ends, active)
                                        : find_blocked(tracer, rays, active, RayOrder::kIncoherent);
    for (uint32_t k = 0; k < kPacketSize; ++k) {
      if (!(active >> k & 1u)) continue;
      const uint32_t block = scratch.block[first + k];
      sums.all[block] += weight[k];
      if (!(blocked >> k & 1u)) sums.seen[block] += weight[k];
    }
  }
}

struct Ball {
  DVec3 centre{0};
  double radius = 0;
};
Ball find_ball(std::span<const DVec3> corners) {
  Ball ball;
  for (const DVec3& p : corners) ball.centre += p;
  ball.centre /= static_cast<double>(corners.size());
  for (const DVec3& p : corners) ball.radius = std::max(ball.radius, length(p - ball.centre));
  return ball;
}

void add_triangles(RayPairTable& pairs, std::span<const DVec3> corners) {
  double sum = 0;
  for (size_t k = 2; k < corners.size(); ++k) {
    pairs.triangle.push_back({corners[0], corners[k - 1], corners[k]});
    pairs.area_until.push_back(sum += find_area(pairs.triangle.back()));
  }
}

}  // namespace

void clear_pairs(RayPairTable& pairs) {
  pairs.exchange_until.clear(), pairs.exchange_inverse.clear();
  pairs.normal_from.clear(), pairs.normal_to.clear();
  pairs.triangle_first.assign(1, 0), pairs.triangle_to.clear(), pairs.far.clear();
  pairs.triangle.clear(), pairs.area_until.clear();
  pairs.off_plane = 0, pairs.shift = DVec3(0), pairs.fine = nullptr;
}

void add_pair(RayPairTable& pairs, std::span<const DVec3> from, DVec3 normal_from, std::span<const DVec3> to,
              DVec3 normal_to, double exchange) {
  assert(exchange > 0);
  Ball ball_from = find_ball(from), ball_to = find_ball(to);
  // Seen from the smaller of the two, the other changes least.
  if (ball_from.radius > ball_to.radius) {
    std::swap(from, to);
    std::swap(normal_from, normal_to);
  }
  pairs.exchange_inverse.push_back(1 / exchange);
  pairs.exchange_until.push_back((pairs.exchange_until.empty() ? 0 : pairs.exchange_until.back()) + exchange);
  pairs.normal_from.push_back(normal_from), pairs.normal_to.push_back(normal_to);
  add_triangles(pairs, from);
  pairs.triangle_to.push_back(static_cast<uint32_t>(pairs.triangle.size()));
  add_triangles(pairs, to);
  pairs.triangle_first.push_back(static_cast<uint32_t>(pairs.triangle.size()));
  pairs.far.push_back(length(ball_from.centre - ball_to.centre) > kFar * (ball_from.radius + ball_to.radius));
}

void add_samples(PairSums& sums, const RayPairTable& pairs, const Tracer& tracer, const Sobol& sobol,
                 SampleScratch& scratch) {
  if (sums.block_count == 2 * kBlocksMin) {
    for (auto* sum : {&sums.all, &sums.seen}) {
      for (uint32_t k = 0; k < kBlocksMin; ++k) (*sum)[k] = (*sum)[2 * k] + (*sum)[2 * k + 1];
      std::fill(sum->begin() + kBlocksMin, sum->end(), 0.0);
    }
    sums.block_count = kBlocksMin, sums.block_size *= 2;
  }
  uint32_t first = sums.sample_count();
  const uint32_t added = std::max(kPacketSize, sums.block_size * (kBlocksMin / 4)), end = first + added;
  for (const uint32_t count = std::min(added, kPointsSorted); first < end; first += count) {
    stop_if_cancelled();
    sort_points(scratch, sobol, first, count, sums.block_size);
    cast_points(sums, pairs, tracer, scratch);
  }
  sums.block_count += added / sums.block_size;
}

Share find_share(const PairSums& sums) {
  double all = 0, seen = 0;
  for (uint32_t k = 0; k < sums.block_count; ++k) all += sums.all[k], seen += sums.seen[k];
  if (!(all > 0)) return {0, 1};
  const double share = seen / all;
  double squares = 0;
  for (uint32_t k = 0; k < sums.block_count; ++k) {
    const double off = sums.seen[k] - share * sums.all[k];
    squares += off * off;
  }
  const double spread = std::sqrt(squares * sums.block_count / (sums.block_count - 1)) / all;
  // Rays that all agree have not shown that the next one would: what they say is no better than 1 in their
  // number.
  return {share, std::max(spread, 1.0 / sums.sample_count())};
}

}  // namespace patchlight
