// A frozen solution -> a mesh of lit corners without cracks: what leaves the program as glb, ply, obj and
// page.
#pragma once

#include "dsl/scene/scene.h"
#include "engine/solve/solve.h"

#include <array>
#include <string>
#include <vector>

namespace patchlight {

// Each leaf is an outline of at least three vertices, counter-clockwise from the lit side. A corner of a
// finer neighbour in the middle of its edge is in it, too, so that no light and no gap shows between the two.
// The fan from the first vertex of an outline is its triangles: none of them is without area.
//
//      3 ----- 2
//      |     / |     Finer leaves on the left have put the corner h on its edge. The outline is
//  ----h ----- |     h 0 1 2 3, the triangles are h 0 1, h 1 2, h 2 3.
//      |     \ |
//      0 ----- 1
//
// Vertices stand polygon by polygon: those of two polygons on one place are two, for they have two normals.
struct LitMesh {
  std::vector<Vec3> position;    // a row a vertex, engine lengths; of one corner the same bits everywhere
  std::vector<Rgb> radiosity;    // a row a vertex, W/m2, after the passes so far
  std::vector<uint32_t> source;  // smooth: its row in element_vertices; flat: its element
  std::vector<uint32_t> outline_first;  // CSR: element -> its outline, elements + 1
  std::vector<uint32_t> outline;        // vertices
  std::vector<uint32_t> vertex_first;   // CSR: polygon -> its vertices, polygons + 1
  std::vector<uint32_t> element_first;  // CSR: polygon -> its elements, polygons + 1
  size_t vertex_count() const { return position.size(); }
  size_t triangle_count() const { return outline.size() - 2 * (outline_first.size() - 1); }
};

// Smooth: neighbours share vertices, with the values of vertex_radiosity(); flat: every leaf has its own,
// with its own value.
// What vertex_radiosity() takes: the guess of what is unshot, where the scene is to show it.
inline Rgb find_shown_ambient(const Scene& scene, const Solution& solution) {
  return scene.output.ambient ? find_ambient(solution) : Rgb(0);
}
LitMesh make_lit_mesh(const Scene& scene, const Solution& solution, Shading shading);

struct TriangleTable {
  std::vector<std::array<uint32_t, 3>> corner;  // vertices, counter-clockwise from the lit side
  std::vector<uint32_t> element;                // the leaf that it is a part of
  std::vector<uint32_t> polygon_first;          // CSR: polygon -> its triangles, polygons + 1
  size_t size() const { return corner.size(); }
};
TriangleTable make_triangles(const LitMesh& mesh);

// Unit normals of the lit sides, a row a polygon: the mean over its area where it is not quite flat.
std::vector<Vec3> find_polygon_normals(const Scene& scene);

// A point in engine lengths as the scene's file says it.
inline DVec3 to_file_units(const Scene& scene, Vec3 point) {
  return scene.origin + DVec3(point) * scene.units_per_length;
}

// What people take for one thing: polygons whose ids differ in their last part only, as hall.floor and
// hall.ceiling do, or lamps[0] and lamps[1]. In the order of the scene.
struct ThingTable {
  std::vector<std::string> name;  // hall, lamps
  std::vector<uint32_t> first;    // CSR: thing -> its polygons
  std::vector<uint32_t> polygon;
  size_t size() const { return name.size(); }
};
ThingTable find_things(const PolygonTable& polygons);

}  // namespace patchlight
