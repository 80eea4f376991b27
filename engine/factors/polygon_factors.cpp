// Pairs of polygons to exchange areas: first what is exact, for all pairs, then rays for those that need
// them.
#include "engine/factors/polygon_factors.h"

#include "engine/base/parallel.h"
#include "engine/factors/contour.h"
#include "engine/factors/pair_rays.h"
#include "engine/factors/pair_split.h"

#include <algorithm>

namespace patchlight {
namespace {

// About so many pairs a step: callers see progress, and lists of tasks stay short.
constexpr size_t kPairsPerStep = 1 << 15;
// The integrals' error, of the factor of the smaller polygon, or of the exchange itself for far pairs.
constexpr double kIntegralError = 1e-7;
constexpr double kIntegralErrorFar = 1e-5;
// Standard errors in an error that is told.
constexpr double kErrorWidth = 3;
// A row is a sum of many factors. Small factors get less than their share of the error: standard errors
// grow with the root of the factor, so that those of a whole row stay near the error that is asked for.
constexpr double kRowShare = 3;
// What the estimate before the last says of the error, too, as a share of it.
constexpr double kErrorKept = 0.8;
constexpr uint32_t kSamplesMax = 1u << 22;
// Errors by rounding are told from this share of the smaller polygon's area on.
constexpr double kErrorTold = 1e-7;
// Rays of single precision start so far from surfaces, as a share of coordinates of at least a quarter of a
// length. They do where that is less than this share of what they go between.
constexpr double kOffset = 2e-6;
constexpr double kOffsetShare = 2e-3;
// Fine rays are slow, and pairs that need them are few.
constexpr uint32_t kFineSamplesMax = 1u << 18;
// The opposite of another normal: the cosine is below.
constexpr double kOpposite = -0.999;

// A pair of parts whose visibility rays must find.
struct Task {
  uint32_t part_a, part_b;
  size_t entry;       // of the table
  double exchange;    // with nothing between, lengths squared
  double area_least;  // of the two polygons
  bool fine;          // too small, or too near each other, for rays of single precision
  double weight = 1;  // how often it counts in the entry
  double share = 1;   // of the error of the entry
};

struct Answer {
  double exchange = 0, error = 0;
  uint32_t rays = 0;
  bool rough = false;
};

size_t find_entry(size_t size, size_t i, size_t j) {
  if (i > j) std::swap(i, j);
  return i * size - i * (i + 1) / 2 + j;
}

// Memory that a range of pairs reuses.
struct PairScratch {
  std::vector<Segment> outline_a, outline_b;
  ShaftEnd end_a, end_b;
  ContourScratch contour;
};

// How far a part lies before the plane of another, and whether it crosses that plane.
struct Before {
  double height = -1e300;  // lengths: of the corner that is furthest before it
  bool crosses = false;
};
Before find_before(const PartTable& parts, uint32_t part, const HalfSpace& front, double touch) {
  Before before;
  const double middle = height_above(front, parts.centre[part]), radius = parts.radius[part];
  if (middle + radius <= 0) return before;
  double least = 1e300;
  for (const DVec3& p : part_hull(parts, part)) {
    const double height = height_above(front, p);
    least = std::min(least, height), before.height = std::max(before.height, height);
  }
  before.crosses = least < -0.5 * touch;
  return before;
}

// Are two parts, which face each other and touch, so placed that the one may cover a part of the other? Two
// sides of one sheet never do, nor those that lie side by side.
bool may_cover(const PartTable& parts, uint32_t a, uint32_t b) {
  if (dot(parts.front[a].normal, parts.front[b].normal) > kOpposite) return false;
  std::vector<DVec3> shared(part_hull(parts, a).begin(), part_hull(parts, a).end()), kept;
  const auto hull = part_hull(parts, b);
  const DVec3 normal = parts.front[b].normal;
  const double margin = parts.touch[a] + parts.touch[b];
  for (size_t k = 0; k < hull.size(); ++k) {
    const DVec3 edge = hull[(k + 1) % hull.size()] - hull[k];
    if (!(length(edge) > 0)) continue;
    const DVec3 inwards = normalize(cross(normal, edge));
    kept.clear();
    clip_polygon(kept, shared, {inwards, dot(inwards, hull[k]) + margin});
    std::swap(shared, kept);
  }
  return shared.size() >= 3;
}

// The part, its outline and hull, as far as it lies before the plane of the other.
std::span<const Segment> prepare_end(ShaftEnd& end, std::vector<Segment>& outline, const PartTable& parts,
                                     uint32_t part, const HalfSpace& front, bool crosses) {
  end.part = part;
  end.hull.clear();
  if (!crosses) {
    const auto hull = part_hull(parts, part);
    end.hull.assign(hull.begin(), hull.end());
    return part_outline(parts, part);
  }
  clip_polygon(end.hull, part_hull(parts, part), front);
  outline.clear();
  clip_outline(outline, part_outline(parts, part), front);
  return outline;
}

double find_tolerance(const PartTable& parts, uint32_t a, uint32_t b, double area_least) {
  const DVec3 way = parts.centre[b] - parts.centre[a];
  const double squared = dot(way, way), reach = 2 * (parts.radius[a] + parts.radius[b]);
  double tolerance = kIntegralError * area_least;
  if (squared > reach * reach) {
    const double cosines = std::abs(dot(way, parts.front[a].normal) * dot(way, parts.front[b].normal));
    tolerance = std::min(tolerance, kIntegralErrorFar * parts.area[a] * parts.area[b] * cosines /
                                        (std::numbers::pi * squared * squared));
  }
  return tolerance;
}

struct StepCounts {
  uint64_t clear = 0, hidden = 0;
};

// What rounding of corners and of sums may change of an exchange, where that is worth telling. Corners that
// move by the rounding move the border of what is seen, and turn the smaller of the two: both change the
// exchange by the rounding times the smaller one's outline, at most, and far ones by less.
double find_rounding_error(const PartTable& parts, uint32_t a, uint32_t b, std::span<const Segment> outline_a,
                           std::span<const Segment> outline_b, double exchange, double area_least) {
  if (outline_a.empty() || outline_b.empty()) return 0;
  const double small = std::min(parts.radius[a], parts.radius[b]);
  const double moved = (parts.rounding[a] + parts.rounding[b]) * 8 * small;
  double error = moved > kErrorTold * area_least ? moved : 0;
  if (error > 0 || !(exchange > 0)) {
    const DVec3 way = parts.centre[b] - parts.centre[a];
    const double gap = length(way) - parts.radius[a] - parts.radius[b];
    if (gap > 0)
      error *= std::min(1.0, std::max(parts.area[a], parts.area[b]) / (std::numbers::pi * gap * gap));
  }
  const double sums = find_exchange_rounding(outline_a, outline_b);
  if (exchange <= sums) error = std::max(error, sums);
  return error;
}

// Would rays of single precision start beyond what stands between two parts? `height`: how far the one lies
// before the plane of the other.
bool is_small_for_rays(const PartTable& parts, const PairScratch& scratch, const Blockers& blockers,
                       uint32_t a, uint32_t b, double height) {
  DVec3 most(0.25);
  for (const auto* end : {&scratch.end_a, &scratch.end_b})
    for (const DVec3& p : end->hull) most = max(most, abs(p - parts.shift));
  const double offset = kOffset * std::max({most.x, most.y, most.z});
  const double width = std::min(std::sqrt(parts.area[a]), std::sqrt(parts.area[b]));
  if (offset > kOffsetShare * std::min(width, height)) return true;
  // What is between may lie close to the one or the other.
  for (size_t k = 0; k < blockers.count; ++k)
    for (const uint32_t part : {a, b}) {
      double highest = 0;
      for (const DVec3& p : parts.face_corners[blockers.face[k]]) {
        highest = std::max(highest, std::abs(height_above(parts.front[part], p)));
      }
      if (highest < 2 * offset && highest > parts.touch[part]) return true;
    }
  return false;
}

// Are all faces of the one part backs of faces of the other?
bool is_twin(const FactorScene& scene, const FaceTable& faces, uint32_t a, uint32_t b) {
  const auto face = std::find(scene.parts.part_of_face.begin(), scene.parts.part_of_face.end(), a);
  const uint32_t twin = faces.twin[static_cast<size_t>(face - scene.parts.part_of_face.begin())];
  return twin != kNone && scene.parts.part_of_face[twin] == b;
}

// The exchange area of two parts where it is exact; a task where it is not.
double find_exact(PairScratch& scratch, std::vector<Task>& tasks, StepCounts& counts, double& error,
                  const FactorScene& scene, const FaceTable& faces, uint32_t a, uint32_t b, size_t entry,
                  double area_least) {
  const PartTable& parts = scene.parts;
  const double touch = std::max(parts.touch[a], parts.touch[b]);
  const double off_plane = std::max(parts.off_plane[a], parts.off_plane[b]);
  const Before before_a = find_before(parts, a, parts.front[b], touch);
  const Before before_b = find_before(parts, b, parts.front[a], touch);
  const double height = std::min(before_a.height, before_b.height);
  if (height <= touch) {
    // Off plane by more than by rounding: which of the two is before the other is not known.
    if (height > -off_plane && off_plane > 0.5 * touch && may_cover(parts, a, b) &&
        !is_twin(scene, faces, a, b))
      error += std::min(parts.area[a], parts.area[b]);
    return 0;
  }
  const auto outline_a =
      prepare_end(scratch.end_a, scratch.outline_a, parts, a, parts.front[b], before_a.crosses);
  const auto outline_b =
      prepare_end(scratch.end_b, scratch.outline_b, parts, b, parts.front[a], before_b.crosses);
  Blockers blockers;
  const Sight sight = find_sight(blockers, scene.tree, faces, parts, scratch.end_a, scratch.end_b);
  if (sight == Sight::kHidden) {
    ++counts.hidden;
    return 0;
  }
  const bool a_first = parts.radius[a] <= parts.radius[b];
  const double exchange = find_exchange_area(a_first ? outline_a : outline_b, a_first ? outline_b : outline_a,
                                             find_tolerance(parts, a, b, area_least), scratch.contour);
  error += find_rounding_error(parts, a, b, outline_a, outline_b, exchange, area_least);
  if (sight == Sight::kClear) {
    ++counts.clear;
    return exchange;
  }
  if (exchange > 0)
    tasks.push_back({a, b, entry, exchange, area_least,
                     is_small_for_rays(parts, scratch, blockers, a, b, height),
                     parts.polygon[a] == parts.polygon[b] ? 2.0 : 1.0});
  return 0;
}

void find_exact_row(FactorTable& table, std::vector<Task>& tasks, StepCounts& counts, PairScratch& scratch,
                    const FactorScene& scene, const FaceTable& faces, uint32_t i) {
  const auto& first = scene.parts.polygon_first;
  for (uint32_t j = i; j < table.size(); ++j) {
    const size_t entry = find_entry(table.size(), i, j);
    const double area_least = std::min(table.area[i], table.area[j]);
    double sum = 0, error = 0;
    for (uint32_t a = first[i]; a < first[i + 1]; ++a) {
      stop_if_cancelled();
      for (uint32_t b = std::max(first[j], i == j ? a + 1 : 0); b < first[j + 1]; ++b)
        sum += find_exact(scratch, tasks, counts, error, scene, faces, a, b, entry, area_least);
    }
    // Parts of one polygon see each other: what goes from a to b goes from b to a, too.
    table.exchange[entry] = i == j ? 2 * sum : sum;
    table.exchange_error[entry] = static_cast<float>(i == j ? 2 * error : error);
  }
}

// Tasks of one entry, which stand together, have one error between them.
void share_errors(std::vector<Task>& tasks) {
  for (size_t first = 0, last = 0; first < tasks.size(); first = last) {
    while (last < tasks.size() && tasks[last].entry == tasks[first].entry) ++last;
    for (size_t k = first; k < last; ++k) tasks[k].share = 1 / std::sqrt(static_cast<double>(last - first));
  }
}

// Memory that a range of tasks reuses.
struct TaskScratch {
  SplitPair split;
  RayPairTable pairs;
  ContourScratch contour;
  SampleScratch samples;
};

Answer find_by_rays(TaskScratch& scratch, const Task& task, const FactorScene& scene, const FaceTable& faces,
                    const Tracer& tracer, const FactorSettings& settings) {
  const PartTable& parts = scene.parts;
  const double factor = task.exchange / task.area_least;  // the larger one of the two directions
  const double wanted = task.share / task.weight * task.area_least * settings.error / kErrorWidth *
                        std::min(1.0, kRowShare * std::sqrt(factor));
  SplitPair& split = scratch.split;
  split_pair(split, scene.tree, faces, parts, task.part_a, task.part_b, task.exchange, wanted,
             kIntegralError / 10 * task.area_least, scratch.contour);
  Answer answer;
  answer.exchange = split.clear;
  if (split.sub_pairs.empty()) return answer;
  clear_pairs(scratch.pairs);
  for (const SubPair& pair : split.sub_pairs)
    add_pair(scratch.pairs, corners_a(split, pair), parts.front[task.part_a].normal, corners_b(split, pair),
             parts.front[task.part_b].normal, pair.exchange);
  const double mixed = scratch.pairs.exchange_until.back();
  const FineRays fine{scene.tree, faces, parts, task.part_a, task.part_b};
  const uint32_t samples_max = task.fine ? kFineSamplesMax : kSamplesMax;
  scratch.pairs.shift = parts.shift;
  if (task.fine) scratch.pairs.fine = &fine;
  // Faces cut along the one diagonal, and points made along the other, are twice as far apart.
  scratch.pairs.off_plane =
      static_cast<float>(2 * std::max(parts.off_plane[task.part_a], parts.off_plane[task.part_b]));
  const Sobol sobol = make_sobol(make_ray_key(settings.seed, task.part_a, task.part_b, 0, 0));
  PairSums sums;
  Share share{};
  double error_before = 0;
  do {
    add_samples(sums, scratch.pairs, tracer, sobol, scratch.samples);
    share = find_share(sums);
    // An error that is small for once does not end it.
    const double error = share.error;
    share.error = std::max(error, kErrorKept * error_before);
    error_before = error;
  } while (share.error * mixed > wanted && sums.sample_count() < samples_max);
  answer.exchange += share.value * mixed;
  answer.error = kErrorWidth * share.error * mixed;
  answer.rays = sums.sample_count();
  answer.rough = share.error * mixed > wanted;
  return answer;
}

}  // namespace

FactorScene make_factor_scene(const FaceTable& faces, size_t polygon_count, const FineCorners& fine) {
  FactorScene scene{make_parts(faces, polygon_count, fine), {}};
  scene.tree = make_bvh(faces, scene.parts);
  return scene;
}

uint64_t forecast_factor_bytes(size_t polygon_count, size_t face_count) {
  // Measured: 0.4 kB a face for parts, tree and Embree; a step holds tasks for all of its pairs.
  const uint64_t n = polygon_count, pairs = n * (n + 1) / 2;
  const uint64_t step = std::min<uint64_t>(pairs, kPairsPerStep + n);
  return pairs * (sizeof(double) + sizeof(float)) + step * (sizeof(Task) + sizeof(Answer)) +
         uint64_t{face_count} * 1000;
}

FactorTable make_factor_table(const FactorScene& scene, size_t polygon_count) {
  FactorTable table;
  table.area.assign(polygon_count, 0);
  for (uint32_t part = 0; part < scene.parts.size(); ++part)
    table.area[scene.parts.polygon[part]] += scene.parts.area[part];
  table.exchange.assign(polygon_count * (polygon_count + 1) / 2, 0);
  table.exchange_error.assign(table.exchange.size(), 0);
  return table;
}

bool extend_factors(FactorTable& table, const FactorScene& scene, const FaceTable& faces,
                    const Tracer& tracer, const FactorSettings& settings) {
  const uint32_t first = table.row_done;
  uint32_t last = first;
  for (size_t pairs = 0; last < table.size() && pairs < kPairsPerStep; ++last) pairs += table.size() - last;
  if (first == last) return false;

  std::vector<std::vector<Task>> row_tasks(last - first);
  std::vector<StepCounts> row_counts(last - first);
  for_rows(last - first, 1, [&](size_t begin, size_t end) {
    PairScratch scratch;
    for (size_t k = begin; k < end; ++k)
      find_exact_row(table, row_tasks[k], row_counts[k], scratch, scene, faces,
                     first + static_cast<uint32_t>(k));
  });
  std::vector<Task> tasks;
  for (size_t k = 0; k < row_tasks.size(); ++k) {
    tasks.insert(tasks.end(), row_tasks[k].begin(), row_tasks[k].end());
    table.clear_count += row_counts[k].clear, table.hidden_count += row_counts[k].hidden;
  }
  share_errors(tasks);

  std::vector<Answer> answers(tasks.size());
  for_rows(tasks.size(), 1, [&](size_t begin, size_t end) {
    TaskScratch scratch;
    for (size_t k = begin; k < end; ++k)
      answers[k] = find_by_rays(scratch, tasks[k], scene, faces, tracer, settings);
  });
  for (size_t k = 0; k < tasks.size(); ++k) {
    const Answer& answer = answers[k];
    const size_t entry = tasks[k].entry;
    table.exchange[entry] += tasks[k].weight * answer.exchange;
    table.exchange_error[entry] =
        static_cast<float>(std::hypot(double{table.exchange_error[entry]}, tasks[k].weight * answer.error));
    table.ray_count += answer.rays, table.rough_count += answer.rough;
  }
  table.sampled_count += tasks.size();
  table.row_done = last;
  return last < table.size();
}

double find_exchange(const FactorTable& table, size_t i, size_t j) {
  return table.exchange[find_entry(table.size(), i, j)];
}

double find_factor(const FactorTable& table, uint32_t i, uint32_t j) {
  return table.area[i] > 0 ? find_exchange(table, i, j) / table.area[i] : 0;
}

double find_factor_error(const FactorTable& table, uint32_t i, uint32_t j) {
  return table.area[i] > 0 ? table.exchange_error[find_entry(table.size(), i, j)] / table.area[i] : 0;
}

}  // namespace patchlight
