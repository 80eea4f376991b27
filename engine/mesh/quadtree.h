// Leaves of quadtrees: making, finding, neighbours, splitting. All trees are kept balanced: leaves that share
// part of an edge, also across the faces of one polygon, differ by one level at most.
#pragma once

#include "engine/mesh/cell.h"

#include <functional>
#include <numeric>
#include <span>
#include <vector>

namespace patchlight {

// 0 .. count - 1.
inline std::vector<uint32_t> all_rows(size_t count) {
  std::vector<uint32_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0u);
  return rows;
}

// Leaves of `level_of(face)` (at most kLevelMax - 1) on every face, not yet balanced. Radiosity columns start
// at the face's emission.
PatchTable make_leaves(const FaceTable& faces, const FaceFrameTable& frames,
                       const std::function<uint32_t(uint32_t)>& level_of);

// Of the rows [low, high) of one face, the last leaf that starts at or before a cell; the first must.
inline uint32_t find_leaf_between(const PatchTable& leaves, uint32_t low, uint32_t high, uint32_t cell) {
  while (high - low > 1) {
    const uint32_t middle = low + (high - low) / 2;
    (leaves.cell[middle] <= cell ? low : high) = middle;
  }
  return low;
}

// The row of the leaf that holds a cell of level kLevelMax.
uint32_t find_leaf(const PatchTable& leaves, uint32_t face, uint32_t cell);

// The same, sooner, for many questions about one table: where the leaves of each cell of a uniform level
// begin.
struct LeafIndex {
  std::vector<uint32_t> first;  // faces + 1: rows of leaf
  std::vector<uint8_t> level;   // a row a face
  std::vector<uint32_t> leaf;   // the leaf that holds the first code of each cell
};
LeafIndex make_leaf_index(const PatchTable& leaves);
inline uint32_t find_leaf(const PatchTable& leaves, const LeafIndex& index, uint32_t face, uint32_t cell) {
  const uint32_t level = index.level[face];
  const uint32_t at = index.first[face] + static_cast<uint32_t>(uint64_t{cell} >> (32 - 2 * level));
  const uint32_t low = index.leaf[at];
  const uint32_t high = at + 1 < index.first[face + 1] ? index.leaf[at + 1] + 1 : leaves.face_first[face + 1];
  return find_leaf_between(leaves, low, high, cell);
}

// The leaves that share part of edge `edge` with leaf `row`: one, or two that are finer; kNone fills up. At
// the border of a polygon both are kNone.
std::array<uint32_t, 2> find_neighbours(const PatchTable& leaves, const FaceFrameTable& frames,
                                        const FaceLinkTable& links, uint32_t row, uint32_t edge);
inline uint32_t edge_count(const FaceFrameTable& frames, uint32_t face) {
  return frames.triangle[face] ? 3 : 4;
}

// The leaf across an edge if it is as large as leaf `row` or larger, else kNone.
uint32_t find_coarse_neighbour(const PatchTable& leaves, const FaceFrameTable& frames,
                               const FaceLinkTable& links, uint32_t row, uint32_t edge);

// Marks, too, what must be split so that splitting the marked leaves keeps the tree balanced. A row a leaf.
void mark_for_balance(std::vector<uint8_t>& marks, const PatchTable& leaves, const FaceFrameTable& frames,
                      const FaceLinkTable& links);

// Of the leaves with a weight above 0 those that a budget has room for, of most weight first, and what
// balance asks for with them: that counts towards the budget, too, and where it takes too much, fewer are
// marked. Both columns have a row a leaf; all marks are 0 if nothing fits.
std::vector<uint8_t> mark_within_budget(std::span<const float> weight, const PatchTable& leaves,
                                        const FaceFrameTable& frames, const FaceLinkTable& links,
                                        uint64_t leaf_count_max);

// Splits the marked leaves into four; the children inherit all columns (same W/m2, so the power is
// unchanged), a quarter each of the area as their shapes have it. parent[row of the result] = row before.
PatchTable split_leaves(const PatchTable& leaves, const FaceFrameTable& frames,
                        std::span<const uint8_t> marks, std::vector<uint32_t>& parent);

// Splits until neighbours differ by one level at most.
void balance_leaves(PatchTable& leaves, const FaceFrameTable& frames, const FaceLinkTable& links);

// CSR: row of `coarse` -> rows of `fine`, where every coarse leaf is a union of fine ones; coarse.size() + 1
// entries.
std::vector<uint32_t> find_union_ranges(const PatchTable& coarse, const PatchTable& fine);

}  // namespace patchlight
