// Noisy values of leaves to smoother ones.
#include "engine/transport/smoothing.h"

#include "engine/base/parallel.h"
#include "engine/mesh/quadtree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace patchlight {
namespace {

// A step brings a leaf half of the way to the mean of its neighbours.
constexpr float kStep = 0.5f;
// Over so many steps' width squared errors are averaged before they choose: a single sample says little.
constexpr uint32_t kAveragingSteps = 8;
// The chosen strength changes gradually from leaf to leaf.
constexpr uint32_t kGradualSteps = 4;

struct Side {
  std::array<uint32_t, 2> leaf = {kNone, kNone};
  Vec3 centre{0};  // of them, their mean
};

Side find_side(const PatchTable& leaves, const Surfaces& surfaces, uint32_t row, uint32_t edge) {
  Side side;
  uint32_t count = 0;
  for (const uint32_t other : find_neighbours(leaves, surfaces.frames, surfaces.smooth_links, row, edge)) {
    if (other == kNone || leaves.exposed[other] == 0) continue;
    const auto [face, cell, level] = name_cell(leaves, other);
    side.centre += cell_centre(surfaces.frames, face, cell, level);
    side.leaf[count++] = other;
  }
  if (count) side.centre /= static_cast<float>(count);
  return side;
}

// The neighbours of one leaf: four sides, two finer ones each.
struct Neighbours {
  uint32_t count = 0;
  std::array<uint32_t, 8> leaf;
  std::array<float, 8> weight;
};

Neighbours find_smoothing_neighbours(const PatchTable& leaves, const Surfaces& surfaces, uint32_t row) {
  Neighbours all;
  if (leaves.exposed[row] == 0) return all;
  const auto [face, cell, level] = name_cell(leaves, row);
  const Vec3 centre = cell_centre(surfaces.frames, face, cell, level);
  const uint32_t sides = edge_count(surfaces.frames, face);
  std::array<Side, 4> side;
  for (uint32_t edge = 0; edge < sides; ++edge) side[edge] = find_side(leaves, surfaces, row, edge);
  const auto has = [&](uint32_t edge) { return side[edge].leaf[0] != kNone; };
  float sum = 0;
  const auto add = [&](const Side& from, float share) {
    const bool two = from.leaf[1] != kNone;
    for (const uint32_t other : from.leaf) {
      if (other == kNone) continue;
      all.leaf[all.count] = other;
      all.weight[all.count++] = two ? 0.5f * share : share;
    }
    sum += share;
  };
  if (sides == 3) {
    if (has(0) && has(1) && has(2))
      for (uint32_t edge = 0; edge < 3; ++edge) add(side[edge], 1);
  } else {
    for (uint32_t edge = 0; edge < 2; ++edge) {
      if (!has(edge) || !has(edge + 2)) continue;
      // A linear change cancels: the nearer side weighs more.
      const float a = distance(side[edge].centre, centre), b = distance(side[edge + 2].centre, centre);
      if (!(a + b > 0)) continue;
      add(side[edge], b / (a + b));
      add(side[edge + 2], a / (a + b));
    }
  }
  for (uint32_t k = 0; k < all.count; ++k) all.weight[k] /= sum;
  return all;
}

// A column that takes steps: rows without an entry in the table keep their values.
template <typename T>
class Stepper {
 public:
  Stepper(std::vector<T> column, const SmoothingTable& smoothing)
      : now(std::move(column)), next_(now), smoothing_(smoothing) {}
  void take_steps(uint32_t count) {
    for (uint32_t k = 0; k < count; ++k) step();
  }
  std::vector<T> now;

 private:
  void step() {
    const SmoothingTable& table = smoothing_;
    for_rows(table.size(), 1024, [&](size_t begin, size_t end) {
      for (size_t entry = begin; entry < end; ++entry) {
        const uint32_t leaf = table.leaf[entry];
        T mean(0);
        for (uint32_t k = table.first[entry]; k < table.first[entry + 1]; ++k)
          mean += table.weight[k] * now[table.neighbour[k]];
        next_[leaf] = now[leaf] + kStep * (mean - now[leaf]);
      }
    });
    std::swap(now, next_);
  }
  std::vector<T> next_;
  const SmoothingTable& smoothing_;
};

uint32_t count_steps(uint32_t strength) {  // beyond those of the strength before
  return strength == 0 ? 0 : strength == 1 ? 1 : 1u << (strength - 2);
}

float square(float x) { return x * x; }

// Light (three channels) and its noise (the fourth) after the steps of each strength.
std::vector<std::vector<Vec4>> smooth_by_strengths(const NoisyColumns& columns,
                                                   const SmoothingTable& smoothing, uint32_t strengths) {
  std::vector<Vec4> column(columns.value.size());
  for (size_t p = 0; p < column.size(); ++p) column[p] = Vec4(columns.value[p], columns.noise[p]);
  Stepper<Vec4> stepper(std::move(column), smoothing);
  std::vector<std::vector<Vec4>> smoothed;
  for (uint32_t s = 0; s < strengths; ++s) {
    stepper.take_steps(count_steps(s));
    smoothed.push_back(stepper.now);
  }
  return smoothed;
}

}  // namespace

SmoothingTable make_smoothing(const PatchTable& leaves, const Surfaces& surfaces,
                              std::span<const uint32_t> which) {
  std::vector<Neighbours> all(which.size());
  for_rows(which.size(), 512, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) all[k] = find_smoothing_neighbours(leaves, surfaces, which[k]);
  });
  SmoothingTable table;
  table.first.push_back(0);
  for (size_t k = 0; k < which.size(); ++k) {
    if (all[k].count == 0) continue;
    table.leaf.push_back(which[k]);
    table.first.push_back(table.first.back() + all[k].count);
    table.neighbour.insert(table.neighbour.end(), all[k].leaf.begin(), all[k].leaf.begin() + all[k].count);
    table.weight.insert(table.weight.end(), all[k].weight.begin(), all[k].weight.begin() + all[k].count);
  }
  return table;
}

void smooth_noise(const NoisyColumns& columns, const SmoothingTable& smoothing, uint32_t strengths) {
  const size_t count = columns.value.size();
  const std::vector<std::vector<Vec4>> smoothed = smooth_by_strengths(columns, smoothing, strengths);
  std::vector<float> least(count), best(count, 0);
  for (uint32_t s = 0; s < strengths; ++s) {
    std::vector<Vec2> squares(count);  // of the light's change, of the noise that is left
    for_rows(count, 4096, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p) {
        const Vec4 was = smoothed[0][p], is = smoothed[s][p];
        squares[p] = {square(mean_channel(Rgb(is) - Rgb(was))) - square(is.w - was.w), square(is.w)};
      }
    });
    Stepper<Vec2> averaged(std::move(squares), smoothing);
    averaged.take_steps(kAveragingSteps);
    for_rows(count, 4096, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p) {
        const float risk = std::max(averaged.now[p].x, 0.0f) + averaged.now[p].y;
        if (s > 0 && risk >= least[p]) continue;
        least[p] = risk;
        best[p] = static_cast<float>(s);
      }
    });
  }
  Stepper<float> strength(std::move(best), smoothing);
  strength.take_steps(kGradualSteps);
  for_rows(count, 4096, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      Vec4 sum(0);
      for (uint32_t s = 0; s < strengths; ++s) {
        const float share = 1 - std::abs(strength.now[p] - static_cast<float>(s));
        if (share > 0) sum += share * smoothed[s][p];
      }
      columns.value[p] = Rgb(sum);
      columns.noise[p] = sum.w;
      columns.error[p] = std::sqrt(least[p]);
    }
  });
}

void keep_power(std::span<Rgb> after, std::span<const Rgb> before, const SmoothingTable& smoothing,
                const PatchTable& leaves, const FaceTable& faces) {
  // Leaves of a polygon follow each other.
  std::vector<size_t> first;
  const auto polygon_of = [&](size_t entry) { return faces.polygon[leaves.face[smoothing.leaf[entry]]]; };
  for (size_t entry = 0; entry < smoothing.size(); ++entry)
    if (entry == 0 || polygon_of(entry) != polygon_of(entry - 1)) first.push_back(entry);
  first.push_back(smoothing.size());
  for_rows(first.size() - 1, 16, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      DRgb sum_before(0), sum_after(0);
      for (size_t entry = first[k]; entry < first[k + 1]; ++entry) {
        const uint32_t leaf = smoothing.leaf[entry];
        const double area = double{leaves.area[leaf]} * leaves.exposed[leaf];
        sum_before += area * DRgb(before[leaf]), sum_after += area * DRgb(after[leaf]);
      }
      Rgb factor(1);
      for (int c = 0; c < 3; ++c)
        if (sum_after[c] > 0) factor[c] = static_cast<float>(sum_before[c] / sum_after[c]);
      for (size_t entry = first[k]; entry < first[k + 1]; ++entry) after[smoothing.leaf[entry]] *= factor;
    }
  });
}

}  // namespace patchlight
