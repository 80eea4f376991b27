// Quadtrees as sorted lists of leaves.
//
// Samet: The Design and Analysis of Spatial Data Structures, 1990 (linear quadtrees, restricted quadtrees).
#include "engine/mesh/quadtree.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cassert>

namespace patchlight {
namespace {

// A cell by its place in the grid of its level. A triangle's turned cell (i, j) shares its long edge with (i,
// j).
struct GridCell {
  uint32_t face = kNone;
  int32_t i = 0, j = 0;
  bool turned = false;
};

GridCell find_grid_cell(bool triangle, uint32_t face, uint32_t cell, uint32_t level) {
  const auto [origin, size] = make_cell_frame(triangle, cell, level);
  const auto n = static_cast<float>(1u << level);
  GridCell place{face, static_cast<int32_t>(origin.x * n), static_cast<int32_t>(origin.y * n), size < 0};
  if (place.turned) --place.i, --place.j;
  return place;
}

uint32_t find_grid_code(bool triangle, const GridCell& place, uint32_t level) {
  const float h = cell_size(level);
  const float inside = triangle ? (place.turned ? 2 / 3.0f : 1 / 3.0f) : 0.5f;
  const Vec2 centre((static_cast<float>(place.i) + inside) * h, (static_cast<float>(place.j) + inside) * h);
  return cell_ancestor(find_cell(triangle, centre), level);
}

// The cell of the same level across an edge; face kNone at the polygon's border.
GridCell step_across(const FaceFrameTable& frames, const FaceLinkTable& links, const GridCell& from,
                     uint32_t edge, uint32_t level) {
  const int32_t n = 1 << level;
  GridCell to = from;
  bool inside = true;
  int32_t along = 0;  // place along the face's edge, if the cell is at it
  if (frames.triangle[from.face]) {
    to.turned = !from.turned;
    const int32_t outward = from.turned ? 1 : -1;
    if (edge == 0) to.j += outward, along = from.i;
    if (edge == 1) along = from.j;
    if (edge == 2) to.i += outward, along = n - 1 - from.j;
    inside = from.turned || (edge == 0 ? from.j > 0 : edge == 1 ? from.i + from.j < n - 1 : from.i > 0);
  } else {
    if (edge == 0) --to.j, along = from.i;
    if (edge == 1) ++to.i, along = from.j;
    if (edge == 2) ++to.j, along = n - 1 - from.i;
    if (edge == 3) --to.i, along = n - 1 - from.j;
    inside = to.i >= 0 && to.j >= 0 && to.i < n && to.j < n;
  }
  if (inside) return to;
  const FaceLinkTable::Edge link = links.edge[from.face][edge];
  if (link.face == kNone) return {};
  const int32_t s = n - 1 - along;  // the other face runs its edge the other way
  if (frames.triangle[link.face]) {
    if (link.edge == 0) return {link.face, s, 0, false};
    if (link.edge == 1) return {link.face, n - 1 - s, s, false};
    return {link.face, 0, n - 1 - s, false};
  }
  if (link.edge == 0) return {link.face, s, 0, false};
  if (link.edge == 1) return {link.face, n - 1, s, false};
  if (link.edge == 2) return {link.face, n - 1 - s, n - 1, false};
  return {link.face, 0, n - 1 - s, false};
}

// The leaf that holds the cell across an edge of a cell: as large, larger, or the first of the finer ones in
// it.
uint32_t find_across(const PatchTable& leaves, const FaceFrameTable& frames, const FaceLinkTable& links,
                     uint32_t face, uint32_t cell, uint32_t level, uint32_t edge) {
  const GridCell from = find_grid_cell(frames.triangle[face], face, cell, level);
  const GridCell to = step_across(frames, links, from, edge, level);
  if (to.face == kNone) return kNone;
  return find_leaf(leaves, to.face, find_grid_code(frames.triangle[to.face], to, level));
}

// The children of a cell that lie along its edge, in the edge's direction.
std::array<uint32_t, 2> children_on_edge(bool triangle, uint32_t edge) {
  if (triangle) return {edge, (edge + 1) % 3};
  constexpr std::array<std::array<uint32_t, 2>, 4> kQuad = {{{0, 1}, {1, 3}, {3, 2}, {2, 0}}};
  return kQuad[edge];
}

uint32_t child_cell(uint32_t cell, uint32_t level, uint32_t child) {
  return cell | child << (30 - 2 * level);
}

}  // namespace

PatchTable make_leaves(const FaceTable& faces, const FaceFrameTable& frames,
                       const std::function<uint32_t(uint32_t)>& level_of) {
  PatchTable leaves;
  std::vector<uint8_t> levels(faces.size());
  leaves.face_first.assign(faces.size() + 1, 0);
  for (uint32_t f = 0; f < faces.size(); ++f) {
    levels[f] = static_cast<uint8_t>(std::min(level_of(f), kLevelMax - 1));
    leaves.face_first[f + 1] = leaves.face_first[f] + (1u << 2 * levels[f]);
  }
  const size_t count = leaves.face_first.back();
  for_each_row_column([&](const char*, auto& column) { column.resize(count); }, leaves);
  leaves.exposed.assign(count, 1);
  for_rows(faces.size(), 64, [&](size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f) {
      const uint32_t face = static_cast<uint32_t>(f);
      for (uint32_t row = leaves.face_first[f]; row < leaves.face_first[f + 1]; ++row) {
        leaves.face[row] = face;
        leaves.level[row] = levels[f];
        leaves.cell[row] = static_cast<uint32_t>((row - leaves.face_first[f]) * cell_span(levels[f]));
        leaves.area[row] = cell_area(frames, face, leaves.cell[row], levels[f]);
        leaves.radiosity[row] = leaves.unshot[row] = faces.emission[f];
      }
    }
  });
  return leaves;
}

uint32_t find_leaf(const PatchTable& leaves, uint32_t face, uint32_t cell) {
  return find_leaf_between(leaves, leaves.face_first[face], leaves.face_first[face + 1], cell);
}

LeafIndex make_leaf_index(const PatchTable& leaves) {
  LeafIndex index;
  const size_t face_count = leaves.face_first.size() - 1;
  index.first.assign(1, 0);
  for (size_t f = 0; f < face_count; ++f) {
    // About a leaf a cell.
    uint32_t level = 0;
    while (level + 1 < kLevelMax && 4u << 2 * level <= leaves.face_first[f + 1] - leaves.face_first[f])
      ++level;
    index.level.push_back(static_cast<uint8_t>(level));
    uint32_t row = leaves.face_first[f];
    for (uint64_t cell = 0; cell < uint64_t{1} << 32; cell += cell_span(level)) {
      while (row + 1 < leaves.face_first[f + 1] && leaves.cell[row + 1] <= cell) ++row;
      index.leaf.push_back(row);
    }
    index.first.push_back(static_cast<uint32_t>(index.leaf.size()));
  }
  return index;
}

uint32_t find_coarse_neighbour(const PatchTable& leaves, const FaceFrameTable& frames,
                               const FaceLinkTable& links, uint32_t row, uint32_t edge) {
  const uint32_t other =
      find_across(leaves, frames, links, leaves.face[row], leaves.cell[row], leaves.level[row], edge);
  return other == kNone || leaves.level[other] > leaves.level[row] ? kNone : other;
}

std::array<uint32_t, 2> find_neighbours(const PatchTable& leaves, const FaceFrameTable& frames,
                                        const FaceLinkTable& links, uint32_t row, uint32_t edge) {
  const uint32_t face = leaves.face[row], cell = leaves.cell[row], level = leaves.level[row];
  const uint32_t other = find_across(leaves, frames, links, face, cell, level, edge);
  if (other == kNone || leaves.level[other] <= level) return {other, kNone};
  const auto children = children_on_edge(frames.triangle[face], edge);
  return {find_across(leaves, frames, links, face, child_cell(cell, level, children[0]), level + 1, edge),
          find_across(leaves, frames, links, face, child_cell(cell, level, children[1]), level + 1, edge)};
}

void mark_for_balance(std::vector<uint8_t>& marks, const PatchTable& leaves, const FaceFrameTable& frames,
                      const FaceLinkTable& links) {
  // A marked leaf pulls coarser neighbours along, these pull theirs: a work list from fine to coarse.
  std::vector<uint32_t> work;
  for (uint32_t row = 0; row < leaves.size(); ++row)
    if (marks[row]) work.push_back(row);
  while (!work.empty()) {
    const uint32_t row = work.back();
    work.pop_back();
    for (uint32_t edge = 0; edge < edge_count(frames, leaves.face[row]); ++edge) {
      const uint32_t other = find_coarse_neighbour(leaves, frames, links, row, edge);
      if (other == kNone || marks[other] || leaves.level[other] >= leaves.level[row]) continue;
      marks[other] = 1;
      work.push_back(other);
    }
  }
}

std::vector<uint8_t> mark_within_budget(std::span<const float> weight, const PatchTable& leaves,
                                        const FaceFrameTable& frames, const FaceLinkTable& links,
                                        uint64_t leaf_count_max) {
  std::vector<uint32_t> candidates;
  for (uint32_t row = 0; row < leaves.size(); ++row)
    if (weight[row] > 0) candidates.push_back(row);
  const uint64_t room = leaf_count_max > leaves.size() ? (leaf_count_max - leaves.size()) / 3 : 0;
  std::vector<uint8_t> marks;
  const auto try_first = [&](size_t count) {
    marks.assign(leaves.size(), 0);
    for (size_t k = 0; k < count; ++k) marks[candidates[k]] = 1;
    mark_for_balance(marks, leaves, frames, links);
    return static_cast<uint64_t>(std::count(marks.begin(), marks.end(), 1)) <= room;
  };
  if (candidates.size() <= room && try_first(candidates.size())) return marks;
  std::sort(candidates.begin(), candidates.end(),
            [&](uint32_t a, uint32_t b) { return weight[a] != weight[b] ? weight[a] > weight[b] : a < b; });
  size_t take = std::min<size_t>(candidates.size(), room);
  while (!try_first(take)) take -= std::max<size_t>(take / 8, 1);  // nothing at all fits always
  return marks;
}

PatchTable split_leaves(const PatchTable& leaves, const FaceFrameTable& frames,
                        std::span<const uint8_t> marks, std::vector<uint32_t>& parent) {
  assert(marks.size() == leaves.size());
  std::vector<uint32_t> first(leaves.size() + 1, 0);
  for (size_t row = 0; row < leaves.size(); ++row) first[row + 1] = first[row] + (marks[row] ? 4 : 1);
  const size_t count = first.back();
  PatchTable result;
  for_each_row_column([&](const char*, auto& column) { column.resize(count); }, result);
  parent.resize(count);
  for_rows(leaves.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const auto [face, cell, level] = name_cell(leaves, row);
      assert(!marks[row] || level < kLevelMax);
      for (uint32_t to = first[row]; to < first[row + 1]; ++to) {
        for_each_row_column([&](const char*, const auto& from, auto& column) { column[to] = from[row]; },
                            leaves, result);
        parent[to] = static_cast<uint32_t>(row);
        if (!marks[row]) continue;
        result.level[to] = static_cast<uint8_t>(level + 1);
        result.cell[to] = child_cell(cell, level, to - first[row]);
        result.area[to] = cell_area(frames, face, result.cell[to], level + 1);
      }
    }
  });
  for (const uint32_t row : leaves.face_first) result.face_first.push_back(first[row]);
  return result;
}

void balance_leaves(PatchTable& leaves, const FaceFrameTable& frames, const FaceLinkTable& links) {
  for (;;) {
    std::vector<uint8_t> marks(leaves.size(), 0);
    std::atomic<bool> any{false};
    for_rows(leaves.size(), 2048, [&](size_t begin, size_t end) {
      for (size_t row = begin; row < end; ++row)
        for (uint32_t edge = 0; edge < edge_count(frames, leaves.face[row]); ++edge) {
          const uint32_t other =
              find_coarse_neighbour(leaves, frames, links, static_cast<uint32_t>(row), edge);
          if (other == kNone || leaves.level[other] + 1 >= leaves.level[row]) continue;
          // Several rows may say the same of one neighbour: an atomic store of the same value.
          std::atomic_ref<uint8_t>(marks[other]).store(1, std::memory_order_relaxed);
          any.store(true, std::memory_order_relaxed);
        }
    });
    if (!any) return;
    std::vector<uint32_t> parent;
    leaves = split_leaves(leaves, frames, marks, parent);
  }
}

std::vector<uint32_t> find_union_ranges(const PatchTable& coarse, const PatchTable& fine) {
  std::vector<uint32_t> first;
  first.reserve(coarse.size() + 1);
  uint32_t row = 0;
  for (size_t k = 0; k < coarse.size(); ++k) {
    while (row < fine.size() && (fine.face[row] < coarse.face[k] ||
                                 (fine.face[row] == coarse.face[k] && fine.cell[row] < coarse.cell[k])))
      ++row;
    first.push_back(row);
  }
  first.push_back(static_cast<uint32_t>(fine.size()));
  return first;
}

}  // namespace patchlight
