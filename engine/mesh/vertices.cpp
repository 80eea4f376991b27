// Leaves to shared corners, leaf values to corner values.
//
// Corners in the middle of a coarser neighbour's edge are constrained to it (Baum, Mann, Smith, Winget:
// Making Radiosity Usable, 1991). Means kept by repeated correction: van Cittert's iteration, limited to the
// range around.
#include "engine/mesh/vertices.h"

#include "engine/base/parallel.h"

#include <atomic>
#include <cassert>
#include <limits>

namespace patchlight {
namespace {

constexpr uint32_t kGrid = 1u << kLevelMax;  // a face's parameters in whole steps 0..kGrid

struct GridPoint {
  uint32_t face, x, y;
};

// A point on an edge of its face as the same point of the face that comes first: one name for each vertex.
GridPoint find_first_name(GridPoint p, const FaceFrameTable& frames, const FaceLinkTable& links) {
  const bool triangle = frames.triangle[p.face];
  const auto corner_point = [&](uint32_t corner) -> GridPoint {
    constexpr uint32_t kX[4] = {0, kGrid, kGrid, 0}, kY[4] = {0, 0, kGrid, kGrid};
    const uint32_t face = corner / 4, k = corner % 4;
    if (frames.triangle[face]) return {face, k == 1 ? kGrid : 0, k == 2 ? kGrid : 0};
    return {face, kX[k], kY[k]};
  };
  uint32_t edge = kNone, along = 0;
  if (triangle) {
    if (p.x == 0 && p.y == 0) return corner_point(links.corner[p.face][0]);
    if (p.x == kGrid) return corner_point(links.corner[p.face][1]);
    if (p.y == kGrid) return corner_point(links.corner[p.face][2]);
    if (p.y == 0)
      edge = 0, along = p.x;
    else if (p.x + p.y == kGrid)
      edge = 1, along = p.y;
    else if (p.x == 0)
      edge = 2, along = kGrid - p.y;
  } else {
    if ((p.x == 0 || p.x == kGrid) && (p.y == 0 || p.y == kGrid))
      return corner_point(links.corner[p.face][p.y == 0 ? (p.x == 0 ? 0 : 1) : (p.x == 0 ? 3 : 2)]);
    if (p.y == 0)
      edge = 0, along = p.x;
    else if (p.x == kGrid)
      edge = 1, along = p.y;
    else if (p.y == kGrid)
      edge = 2, along = kGrid - p.x;
    else if (p.x == 0)
      edge = 3, along = kGrid - p.y;
  }
  if (edge == kNone) return p;
  const FaceLinkTable::Edge link = links.edge[p.face][edge];
  if (link.face == kNone || link.face > p.face) return p;
  const uint32_t s = kGrid - along;  // the other face runs the edge the other way
  if (frames.triangle[link.face]) {
    if (link.edge == 0) return {link.face, s, 0};
    if (link.edge == 1) return {link.face, kGrid - s, s};
    return {link.face, 0, kGrid - s};
  }
  if (link.edge == 0) return {link.face, s, 0};
  if (link.edge == 1) return {link.face, kGrid, s};
  if (link.edge == 2) return {link.face, kGrid - s, kGrid};
  return {link.face, 0, kGrid - s};
}

uint64_t make_key(GridPoint p) { return uint64_t{p.face} << 34 | uint64_t{p.y} << 17 | p.x; }

uint64_t corner_key(uint32_t face, Vec2 uv, const FaceFrameTable& frames, const FaceLinkTable& links) {
  const auto steps = [](float x) { return static_cast<uint32_t>(x * static_cast<float>(kGrid)); };
  return make_key(find_first_name({face, steps(uv.x), steps(uv.y)}, frames, links));
}

}  // namespace

VertexTable make_vertices(const PatchTable& leaves, const FaceFrameTable& frames,
                          const FaceLinkTable& links) {
  VertexTable table;
  // The names of a leaf's corners are found twice: to keep them would take more memory than all else here.
  const auto find_keys = [&](size_t row) {
    const uint32_t face = leaves.face[row];
    const auto corners = cell_corner_parameters(frames.triangle[face], leaves.cell[row], leaves.level[row]);
    std::array<uint64_t, 4> keys;
    for (size_t k = 0; k < 4; ++k) keys[k] = corner_key(face, corners[k], frames, links);
    return keys;
  };
  std::vector<uint64_t> names(leaves.size() * 4);
  for_rows(leaves.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const auto keys = find_keys(row);
      std::copy(keys.begin(), keys.end(), names.begin() + static_cast<std::ptrdiff_t>(4 * row));
    }
  });
  sort_keys(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  names.shrink_to_fit();
  const auto find_vertex = [&](uint64_t key) {
    const auto at = std::lower_bound(names.begin(), names.end(), key);
    assert(at != names.end() && *at == key);
    return static_cast<uint32_t>(at - names.begin());
  };
  table.leaf_vertex.resize(leaves.size());
  for_rows(leaves.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const auto keys = find_keys(row);
      for (size_t k = 0; k < 4; ++k) table.leaf_vertex[row][k] = find_vertex(keys[k]);
    }
  });

  // A fine leaf knows which of its corners hangs: where an edge of its parent is whole on the other side.
  table.hanging_between.assign(names.size(), {kNone, kNone});
  table.border.assign(names.size(), 0);
  std::vector<uint8_t> hanging_level(names.size(), 0);
  // Leaves that share such a corner write the same.
  const auto write = [](auto& slot, auto value) {
    std::atomic_ref(slot).store(value, std::memory_order_relaxed);
  };
  for_rows(leaves.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const uint32_t face = leaves.face[row], level = leaves.level[row], edges = edge_count(frames, face);
      for (uint32_t edge = 0; edge < edges; ++edge) {
        const uint32_t from = table.leaf_vertex[row][edge], to = table.leaf_vertex[row][(edge + 1) % edges];
        const uint32_t other = find_coarse_neighbour(leaves, frames, links, static_cast<uint32_t>(row), edge);
        if (other == kNone) {
          // Finer leaves on the other side, or none at all.
          if (find_neighbours(leaves, frames, links, static_cast<uint32_t>(row), edge)[0] == kNone)
            write(table.border[from], uint8_t{1}), write(table.border[to], uint8_t{1});
          continue;
        }
        if (leaves.level[other] == level) continue;
        const uint32_t parent = cell_ancestor(leaves.cell[row], level - 1);
        const auto ends = cell_corner_parameters(frames.triangle[face], parent, level - 1);
        const uint32_t first = find_vertex(corner_key(face, ends[edge], frames, links));
        const uint32_t second = find_vertex(corner_key(face, ends[(edge + 1) % edges], frames, links));
        const uint32_t hanging = from == first ? to : from;
        write(table.hanging_between[hanging][0], first), write(table.hanging_between[hanging][1], second);
        write(hanging_level[hanging], static_cast<uint8_t>(level));
      }
    }
  });
  // The ends of a coarse edge may hang themselves, but only on edges that are coarser still.
  for (uint32_t vertex = 0; vertex < names.size(); ++vertex)
    if (table.hanging_between[vertex][0] != kNone) table.hanging_order.push_back(vertex);
  std::stable_sort(table.hanging_order.begin(), table.hanging_order.end(),
                   [&](uint32_t a, uint32_t b) { return hanging_level[a] < hanging_level[b]; });

  table.vertex_first.assign(names.size() + 1, 0);
  for (size_t row = 0; row < leaves.size(); ++row)
    for (uint32_t k = 0; k < edge_count(frames, leaves.face[row]); ++k)
      ++table.vertex_first[table.leaf_vertex[row][k] + 1];
  for (size_t k = 0; k < names.size(); ++k) table.vertex_first[k + 1] += table.vertex_first[k];
  table.vertex_leaf.resize(table.vertex_first.back());
  std::vector<uint32_t> next(table.vertex_first.begin(), table.vertex_first.end() - 1);
  for (size_t row = 0; row < leaves.size(); ++row)
    for (uint32_t k = 0; k < edge_count(frames, leaves.face[row]); ++k)
      table.vertex_leaf[next[table.leaf_vertex[row][k]]++] = static_cast<uint32_t>(row);
  return table;
}

std::vector<Rgb> reconstruct(const LeafSurface& surface, std::span<const Rgb> leaf_values,
                             const ReconstructSettings& settings) {
  const VertexTable& vertices = surface.vertices;
  const PatchTable& leaves = surface.leaves;
  assert(leaf_values.size() == leaves.size());
  std::vector<Rgb> values(vertices.size(), Rgb(0)), low(vertices.size()), high(vertices.size());
  const auto leaf_weight = [&](uint32_t leaf) { return leaves.exposed[leaf] * leaves.exposed[leaf]; };
  const auto hold_hanging = [&] {
    for (const uint32_t vertex : vertices.hanging_order) {
      const auto [a, b] = vertices.hanging_between[vertex];
      values[vertex] = 0.5f * (values[a] + values[b]);
    }
  };
  for_rows(vertices.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      Rgb sum(0), least(std::numeric_limits<float>::max()), most(0);
      float weight_sum = 0;
      for (uint32_t k = vertices.vertex_first[v]; k < vertices.vertex_first[v + 1]; ++k) {
        const uint32_t leaf = vertices.vertex_leaf[k];
        const float weight = leaf_weight(leaf);
        if (weight == 0) continue;
        sum += weight * leaf_values[leaf];
        weight_sum += weight;
        least = min(least, leaf_values[leaf]);
        most = max(most, leaf_values[leaf]);
      }
      values[v] = weight_sum > 0 ? sum / weight_sum : Rgb(0);
      // On a border the leaves around lie on one side: leave room to follow the slope outwards.
      low[v] = vertices.border[v] ? 0.5f * min(least, values[v]) : min(least, values[v]);
      high[v] = vertices.border[v] ? 1.5f * most : most;
    }
  });
  hold_hanging();
  std::vector<Rgb> missing(leaves.size());
  for (uint32_t step = 0; step < std::max(settings.sharpen_steps, settings.border_steps); ++step) {
    for_rows(leaves.size(), 4096, [&](size_t begin, size_t end) {
      for (size_t row = begin; row < end; ++row)
        missing[row] = leaf_values[row] - leaf_mean(surface, values, row);
    });
    for_rows(vertices.size(), 4096, [&](size_t begin, size_t end) {
      for (size_t v = begin; v < end; ++v) {
        if (step >= (vertices.border[v] ? settings.border_steps : settings.sharpen_steps)) continue;
        Rgb sum(0);
        float weight_sum = 0;
        for (uint32_t k = vertices.vertex_first[v]; k < vertices.vertex_first[v + 1]; ++k) {
          const float weight = leaf_weight(vertices.vertex_leaf[k]);
          sum += weight * missing[vertices.vertex_leaf[k]];
          weight_sum += weight;
        }
        if (weight_sum > 0) values[v] = clamp(values[v] + sum / weight_sum, low[v], high[v]);
      }
    });
    hold_hanging();
  }
  return values;
}

}  // namespace patchlight
