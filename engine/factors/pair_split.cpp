// Halving of the pairs in doubt.
#include "engine/factors/pair_split.h"

#include "engine/base/parallel.h"

#include <algorithm>

namespace patchlight {
namespace {

// A split costs about as much as so many rays.
constexpr double kSamplesPerSplit = 600;
constexpr size_t kSplitsMax = 1000;
// A plane cuts a polygon if this share of its depth lies on either side, and leaves it whole below that one.
constexpr double kCutMin = 0.02;
constexpr double kUncut = 1e-5;

struct Job {
  SplitPair& split;
  const Bvh& tree;
  const FaceTable& faces;
  const PartTable& parts;
  uint32_t part_a, part_b;
  double tolerance;
  ContourScratch& scratch;
  std::vector<Segment> outline_a, outline_b;
  std::vector<DVec3> kept;
  ShaftEnd end_a, end_b;
  Blockers blockers;
};

void set_outline(std::vector<Segment>& outline, std::span<const DVec3> corners) {
  outline.clear();
  for (size_t k = 0; k < corners.size(); ++k)
    outline.push_back({corners[k], corners[k + 1 == corners.size() ? 0 : k + 1]});
}

double find_exchange(Job& job, const SubPair& pair) {
  set_outline(job.outline_a, corners_a(job.split, pair));
  set_outline(job.outline_b, corners_b(job.split, pair));
  return find_exchange_area(job.outline_a, job.outline_b, job.tolerance, job.scratch);
}

// How evenly a plane cuts a polygon: 0.5 through the middle of its depth, 0 or less beside it.
double find_cut(std::span<const DVec3> corners, const HalfSpace& plane) {
  double low = 1e300, high = -1e300;
  for (const DVec3& p : corners) {
    const double height = height_above(plane, p);
    low = std::min(low, height), high = std::max(high, height);
  }
  return std::min(-low, high) / std::max(high - low, 1e-300);
}

// Of the faces that were found in a shaft the one whose plane leaves one end whole and cuts the other most
// evenly: what lies on the near side of the cut is not hidden by it.
void pick_blocker(Job& job, SubPair& pair) {
  pair.blocker = kNone;
  double best = kCutMin;
  for (size_t k = 0; k < job.blockers.count; ++k) {
    const uint32_t face = job.blockers.face[k];
    const DVec3 normal(job.faces.normal[face]);
    const HalfSpace plane{normal, dot(normal, job.parts.face_corners[face][0])};
    const double cut_a = find_cut(corners_a(job.split, pair), plane);
    const double cut_b = find_cut(corners_b(job.split, pair), plane);
    if (cut_a < kUncut && cut_b > best) best = cut_b, pair.blocker = face, pair.cuts_a = 0;
    if (cut_b < kUncut && cut_a > best) best = cut_a, pair.blocker = face, pair.cuts_a = 1;
  }
}

Sight find_sub_sight(Job& job, SubPair& pair) {
  job.end_a.part = job.part_a, job.end_b.part = job.part_b;
  set_hull(job.end_a.hull, corners_a(job.split, pair), true, job.parts.front[job.part_a].normal);
  set_hull(job.end_b.hull, corners_b(job.split, pair), true, job.parts.front[job.part_b].normal);
  const Sight sight = find_sight(job.blockers, job.tree, job.faces, job.parts, job.end_a, job.end_b);
  if (sight == Sight::kMixed) pick_blocker(job, pair);
  return sight;
}

bool has_less(const SubPair& a, const SubPair& b) {
  return a.exchange != b.exchange ? a.exchange < b.exchange
                                  : std::pair(a.first_a, a.first_b) < std::pair(b.first_a, b.first_b);
}

// Puts a pair where it belongs. Its exchange need not be known where nothing passes.
void sort_in(Job& job, const SubPair& pair, Sight sight) {
  if (sight == Sight::kHidden || !(pair.exchange > 0)) return;
  if (sight == Sight::kClear) {
    job.split.clear += pair.exchange;
    return;
  }
  job.split.mixed += pair.exchange;
  job.split.sub_pairs.push_back(pair);
  std::push_heap(job.split.sub_pairs.begin(), job.split.sub_pairs.end(), has_less);
}

// The pair as it is, where each of the two is one piece. False, with nothing written, where it is not.
bool add_whole(Job& job, double exchange) {
  const PartTable& parts = job.parts;
  const uint32_t a = parts.piece_first[job.part_a], b = parts.piece_first[job.part_b];
  if (parts.piece_first[job.part_a + 1] - a != 1 || parts.piece_first[job.part_b + 1] - b != 1) return false;
  auto& corners = job.split.corners;
  SubPair pair{exchange, 0, 0, 0, 0, kNone, 0};
  pair.count_a =
      static_cast<uint32_t>(clip_polygon(corners, piece_corners(parts, a), parts.front[job.part_b]));
  pair.first_b = pair.count_a;
  pair.count_b =
      static_cast<uint32_t>(clip_polygon(corners, piece_corners(parts, b), parts.front[job.part_a]));
  if (pair.count_a >= 3 && pair.count_b >= 3) sort_in(job, pair, Sight::kMixed);
  return true;
}

void add_pieces(Job& job) {
  const PartTable& parts = job.parts;
  for (uint32_t a = parts.piece_first[job.part_a]; a < parts.piece_first[job.part_a + 1]; ++a) {
    auto& corners = job.split.corners;
    const auto first_a = static_cast<uint32_t>(corners.size());
    const auto count_a =
        static_cast<uint32_t>(clip_polygon(corners, piece_corners(parts, a), parts.front[job.part_b]));
    if (count_a < 3) continue;
    for (uint32_t b = parts.piece_first[job.part_b]; b < parts.piece_first[job.part_b + 1]; ++b) {
      stop_if_cancelled();
      SubPair pair{0, first_a, count_a, static_cast<uint32_t>(corners.size()), 0, kNone, 0};
      pair.count_b =
          static_cast<uint32_t>(clip_polygon(corners, piece_corners(parts, b), parts.front[job.part_a]));
      if (pair.count_b < 3) continue;
      const Sight sight = find_sub_sight(job, pair);
      if (sight == Sight::kHidden) continue;
      pair.exchange = find_exchange(job, pair);
      sort_in(job, pair, sight);
    }
  }
}

struct Extent {
  DVec3 along{0};
  double low = 0, high = 0;
};
// How long a polygon is along its longest edge.
Extent find_extent(std::span<const DVec3> corners) {
  Extent extent;
  for (size_t k = 0; k < corners.size(); ++k) {
    const DVec3 edge = corners[(k + 1) % corners.size()] - corners[k];
    if (dot(edge, edge) > dot(extent.along, extent.along)) extent.along = edge;
  }
  extent.along /= std::max(length(extent.along), 1e-300);
  extent.low = 1e300, extent.high = -1e300;
  for (const DVec3& p : corners) {
    const double at = dot(p, extent.along);
    extent.low = std::min(extent.low, at), extent.high = std::max(extent.high, at);
  }
  return extent;
}

// The part of one end of a pair on one side of its middle; fewer than three corners: nothing.
SubPair take_half(Job& job, const SubPair& pair, bool of_a, const HalfSpace& side) {
  const auto whole = of_a ? corners_a(job.split, pair) : corners_b(job.split, pair);
  job.kept.clear();
  clip_polygon(job.kept, whole, side);
  SubPair half = pair;
  (of_a ? half.first_a : half.first_b) = static_cast<uint32_t>(job.split.corners.size());
  (of_a ? half.count_a : half.count_b) = static_cast<uint32_t>(job.kept.size());
  job.split.corners.insert(job.split.corners.end(), job.kept.begin(), job.kept.end());
  return half;
}

// Halves the longer end of the pair with the largest exchange.
void split_largest(Job& job) {
  auto& heap = job.split.sub_pairs;
  std::pop_heap(heap.begin(), heap.end(), has_less);
  const SubPair pair = heap.back();
  heap.pop_back();
  job.split.mixed -= pair.exchange;
  HalfSpace plane;
  bool of_a = pair.cuts_a;
  if (pair.blocker != kNone) {
    plane.normal = DVec3(job.faces.normal[pair.blocker]);
    plane.height = dot(plane.normal, job.parts.face_corners[pair.blocker][0]);
  } else {
    const Extent a = find_extent(corners_a(job.split, pair)), b = find_extent(corners_b(job.split, pair));
    of_a = a.high - a.low >= b.high - b.low;
    const Extent& extent = of_a ? a : b;
    plane = {extent.along, 0.5 * (extent.low + extent.high)};
  }
  SubPair low = take_half(job, pair, of_a, {-plane.normal, -plane.height});
  SubPair high = take_half(job, pair, of_a, plane);
  const Sight sight_low = find_sub_sight(job, low), sight_high = find_sub_sight(job, high);
  if (sight_low == sight_high && sight_low != Sight::kMixed)
    low.exchange = pair.exchange;
  else
    low.exchange = std::min(find_exchange(job, low), pair.exchange);
  high.exchange = pair.exchange - low.exchange;  // what the one does not have the other has
  sort_in(job, low, sight_low);
  sort_in(job, high, sight_high);
}

}  // namespace

void split_pair(SplitPair& split, const Bvh& tree, const FaceTable& faces, const PartTable& parts,
                uint32_t part_a, uint32_t part_b, double exchange, double error, double tolerance,
                ContourScratch& scratch) {
  split.clear = split.mixed = 0;
  split.sub_pairs.clear(), split.corners.clear();
  Job job{split, tree, faces, parts, part_a, part_b, tolerance, scratch, {}, {}, {}, {}, {}, {}};
  if (forecast_samples(exchange, error) < kSamplesPerSplit && add_whole(job, exchange)) return;
  add_pieces(job);
  for (size_t splits = 0; splits < kSplitsMax && !split.sub_pairs.empty(); ++splits) {
    stop_if_cancelled();
    const double samples = forecast_samples(split.mixed, error);
    if (samples * split.sub_pairs.front().exchange < kSamplesPerSplit * split.mixed) break;
    split_largest(job);
  }
}

}  // namespace patchlight
