// The tables of the engine: read this file first.
//
// One struct a table, one std::vector a column, all columns of a table equally long, every fact stored once,
// rows named by index. Lengths are in engine lengths: the loader moves and scales every scene so that the
// square root of its area is about 1; radiosity does not depend on the scale. Areas are lengths squared.
// Emission and radiosity are W/m2 (exitance: radiance times pi), reflectance is 0..1, all of them linear RGB.
#pragma once

#include "engine/base/vector.h"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace patchlight {

// The scene, fixed: planar triangles and convex quads. A face is lit on one side only: the side from which
// its corners run counter-clockwise. What reaches its back is absorbed.
struct FaceTable {
  std::vector<std::array<Vec3, 4>>
      corners;                        // lengths; a triangle repeats its third corner in the fourth place
  std::vector<uint8_t> corner_count;  // 3 or 4
  std::vector<Vec3> normal;           // unit, towards the lit side
  std::vector<Rgb> emission;          // W/m2, >= 0
  std::vector<Rgb> reflectance;       // 0..1
  std::vector<uint32_t> polygon;      // the scene's polygon that this face was cut from; ascending
  std::vector<uint32_t> surface;      // faces of one curved surface, whose edges may be smooth; kNone: none
  std::vector<uint32_t> twin;         // the face back to back with this one (two-sided), or kNone
  std::vector<float> patch_size;      // longest edge of a starting patch on it; 0: as the settings say
  std::vector<float> patch_size_min;  // of one that may still be split; 0: as the settings say
  std::vector<uint8_t> level_min;     // it starts at least this often halved
  size_t size() const { return normal.size(); }
};

// What is derived from a face for speed: maps from a point on it to its parameters (see cell.h).
struct FaceFrameTable {
  std::vector<Vec3> origin;  // the first corner
  std::vector<Vec3> edge_u;  // corner 1 - corner 0
  std::vector<Vec3> edge_v;  // last corner - corner 0
  std::vector<Vec3> twist;  // corner 2 - corner 1 - corner 3 + corner 0: zero for a parallelogram or triangle
  std::vector<Vec3> dual_u;  // dot(p - origin, dual_u) = u where twist is zero
  std::vector<Vec3> dual_v;
  std::vector<uint8_t> triangle;  // 1: triangle
  std::vector<uint8_t> affine;    // 1: twist is zero
  size_t size() const { return origin.size(); }
};

// Which edges and corners of faces are the same, so that light is continuous across them: those of the faces
// of one polygon, or also those of the polygons of a smooth surface.
struct FaceLinkTable {
  struct Edge {
    uint32_t face = kNone;  // the face on the other side, or kNone at the polygon's border
    uint8_t edge = 0;       // its edge; it runs the other way
  };
  std::vector<std::array<Edge, 4>> edge;        // edge k runs from corner k to the next one
  std::vector<std::array<uint32_t, 4>> corner;  // 4 * face + corner of the first face that has this corner
  size_t size() const { return edge.size(); }
};

// Leaves of one quadtree per face, sorted by (face, cell): memory order is spatial order and a face owns the
// row range [face_first[f], face_first[f + 1]). Two of these exist: fine elements that carry direct light and
// the picture, and coarser patches that carry the light between surfaces (Cohen, Greenberg, Immel, Brock: An
// Efficient Radiosity Approach for Realistic Image Synthesis, 1986). Every patch is a union of elements.
struct PatchTable {
  std::vector<uint32_t> face;
  std::vector<uint32_t> cell;        // base-4 path from the root, two bits a level, left-aligned (see cell.h)
  std::vector<uint8_t> level;        // 0: the whole face; at most kLevelMax
  std::vector<float> area;           // lengths squared
  std::vector<float> exposed;        // 0..1, the share that does not lie buried in a solid
  std::vector<Rgb> radiosity;        // W/m2, mean over the exposed area: emission and all passes so far
  std::vector<Rgb> unshot;           // W/m2, the part of radiosity not sent yet: what the last pass added
  std::vector<uint32_t> face_first;  // faces + 1 row indices
  size_t size() const { return face.size(); }
};

// Why a leaf is as small as it is: its parent was split for the mesh to start from, for a difference of
// direct light (a shadow's edge) or of light from other surfaces, or because a neighbour had become much
// smaller.
enum class SplitReason : uint8_t { kStart, kDirect, kIndirect, kBalance };

// Corners of leaves, shared between neighbours. A corner in the middle of a coarser neighbour's edge
// (hanging) is held to the mean of that edge's ends, so that the surface of values has no cracks.
struct VertexTable {
  std::vector<std::array<uint32_t, 4>> leaf_vertex;  // a row a leaf; a triangle repeats its third
  std::vector<uint32_t> vertex_first;                // CSR: vertex -> its leaves
  std::vector<uint32_t> vertex_leaf;
  std::vector<std::array<uint32_t, 2>> hanging_between;  // a row a vertex; kNone, kNone: not hanging
  std::vector<uint32_t> hanging_order;                   // hanging vertices, coarse ones first
  std::vector<uint8_t> border;                           // 1: on the border of its polygon
  size_t size() const { return border.size(); }
};

// Who casts rows of rays: a patch, or many small ones that share a row. All patches of a receiver get the
// same irradiance from its row.
struct ReceiverTable {
  std::vector<uint32_t> first;  // CSR: receiver -> its patches
  std::vector<uint32_t> patch;
  std::vector<float>
      area_until;  // a row an entry of patch: share of the receiver's area up to its end; the last is 1
  std::vector<Vec3> centre, normal;   // lengths, unit: means over the area
  std::vector<uint32_t> receiver_of;  // a row a patch
  size_t size() const { return centre.size(); }
};

// Which groups of emitters (light/emitters.h) each receiver may see: a row a receiver and group.
struct SightTable {
  std::vector<uint32_t> first;  // CSR: receiver -> its rows
  std::vector<uint32_t> group;
  std::vector<uint64_t> pieces;  // bit k: piece k of the group may be seen
  std::vector<uint8_t> clear;    // 1: all of it is, from everywhere here
  size_t size() const { return group.size(); }
};

// Where the row rays of each receiver ended: ray_count entries a receiver, for geometry does not change.
// Where that does not fit in memory the first two columns are empty, and rows are cast again when asked for
// (rows.h).
struct HitTable {
  std::vector<uint32_t> patch;                  // the patch hit, or kHitNothing, kHitBack, kHitBuried
  std::vector<uint32_t> cell;                   // where on the patch's face: a cell of level kLevelMax
  std::vector<uint32_t> nothing, back, buried;  // a row a receiver: how many of its rays ended so
  uint32_t ray_count = 0;                       // rays a row
  uint32_t valid_count(size_t row) const { return ray_count - buried[row]; }
  size_t size() const { return buried.size(); }
};
constexpr uint32_t kHitNothing = ~uint32_t{0};    // the ray left the scene
constexpr uint32_t kHitBack = kHitNothing - 1;    // it met a back side
constexpr uint32_t kHitBuried = kHitNothing - 2;  // it started inside a solid: no ray at all

// Bright places that a pass aims at: nodes of the element trees.
struct SourceTable {
  std::vector<uint32_t> face;
  std::vector<uint32_t> element_first, element_last;  // rows of the elements under the node
  std::vector<uint32_t> cell;
  std::vector<uint8_t> level;
  std::vector<Vec3> centre, normal;
  std::vector<float> area;  // lengths squared
  std::vector<double>
      flux;  // sent by the exposed area under the node: W/m2 (luminance) times lengths squared
  std::vector<double> flux_before;  // a row an element and one more: flux of the elements before it
  // A row an element: of the n of a source, the k-th: which of them holds its flux from the share k / n on.
  std::vector<uint32_t> guide;
  // The sources once more, as columns for loops over lanes.
  std::vector<float> x, y, z, normal_x, normal_y, normal_z;
  std::vector<float> share;  // of all flux
  size_t size() const { return face.size(); }
};

// The columns of each table, listed once: for all that goes over them.
template <typename Member>
struct TableColumn {
  const char* name;
  Member member;
  bool has_rows = true;  // a row a row of the table; false: rows of its own
};
template <typename Member>
TableColumn(const char*, Member) -> TableColumn<Member>;
template <typename Member>
TableColumn(const char*, Member, bool) -> TableColumn<Member>;

constexpr auto list_columns(const FaceTable*) {
  using T = FaceTable;
  return std::tuple{
      TableColumn{"corners", &T::corners},         TableColumn{"corner_count", &T::corner_count},
      TableColumn{"normal", &T::normal},           TableColumn{"emission", &T::emission},
      TableColumn{"reflectance", &T::reflectance}, TableColumn{"polygon", &T::polygon},
      TableColumn{"surface", &T::surface},         TableColumn{"twin", &T::twin},
      TableColumn{"patch_size", &T::patch_size},   TableColumn{"patch_size_min", &T::patch_size_min},
      TableColumn{"level_min", &T::level_min}};
}
constexpr auto list_columns(const FaceFrameTable*) {
  using T = FaceFrameTable;
  return std::tuple{TableColumn{"origin", &T::origin},     TableColumn{"edge_u", &T::edge_u},
                    TableColumn{"edge_v", &T::edge_v},     TableColumn{"twist", &T::twist},
                    TableColumn{"dual_u", &T::dual_u},     TableColumn{"dual_v", &T::dual_v},
                    TableColumn{"triangle", &T::triangle}, TableColumn{"affine", &T::affine}};
}
constexpr auto list_columns(const FaceLinkTable*) {
  using T = FaceLinkTable;
  return std::tuple{TableColumn{"edge", &T::edge}, TableColumn{"corner", &T::corner}};
}
constexpr auto list_columns(const PatchTable*) {
  using T = PatchTable;
  return std::tuple{TableColumn{"face", &T::face},       TableColumn{"cell", &T::cell},
                    TableColumn{"level", &T::level},     TableColumn{"area", &T::area},
                    TableColumn{"exposed", &T::exposed}, TableColumn{"radiosity", &T::radiosity},
                    TableColumn{"unshot", &T::unshot},   TableColumn{"face_first", &T::face_first, false}};
}
constexpr auto list_columns(const VertexTable*) {
  using T = VertexTable;
  return std::tuple{TableColumn{"leaf_vertex", &T::leaf_vertex, false},
                    TableColumn{"vertex_first", &T::vertex_first, false},
                    TableColumn{"vertex_leaf", &T::vertex_leaf, false},
                    TableColumn{"hanging_between", &T::hanging_between},
                    TableColumn{"hanging_order", &T::hanging_order, false},
                    TableColumn{"border", &T::border}};
}
constexpr auto list_columns(const SightTable*) {
  using T = SightTable;
  return std::tuple{TableColumn{"first", &T::first, false}, TableColumn{"group", &T::group},
                    TableColumn{"pieces", &T::pieces}, TableColumn{"clear", &T::clear}};
}
constexpr auto list_columns(const ReceiverTable*) {
  using T = ReceiverTable;
  return std::tuple{TableColumn{"first", &T::first, false},
                    TableColumn{"patch", &T::patch, false},
                    TableColumn{"area_until", &T::area_until, false},
                    TableColumn{"centre", &T::centre},
                    TableColumn{"normal", &T::normal},
                    TableColumn{"receiver_of", &T::receiver_of, false}};
}
constexpr auto list_columns(const HitTable*) {
  using T = HitTable;
  return std::tuple{TableColumn{"patch", &T::patch, false}, TableColumn{"cell", &T::cell, false},
                    TableColumn{"nothing", &T::nothing}, TableColumn{"back", &T::back},
                    TableColumn{"buried", &T::buried}};
}

// Calls visit(name, column, column of each other table) for every column; the tables are of one type.
template <typename Visit, typename Table, typename... Others>
void for_each_column(const Visit& visit, Table& table, Others&... others) {
  const auto call = [&](const auto& column) {
    visit(column.name, table.*column.member, others.*column.member...);
  };
  std::apply([&](const auto&... columns) { (call(columns), ...); }, list_columns(&table));
}
// The same for the columns that have a row a row of the table.
template <typename Visit, typename Table, typename... Others>
void for_each_row_column(const Visit& visit, Table& table, Others&... others) {
  const auto call = [&](const auto& column) {
    if (column.has_rows) visit(column.name, table.*column.member, others.*column.member...);
  };
  std::apply([&](const auto&... columns) { (call(columns), ...); }, list_columns(&table));
}

}  // namespace patchlight
