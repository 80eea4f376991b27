// Leaves to a mesh without cracks.
#include "tools/export/lit_mesh.h"

#include "engine/mesh/face_links.h"
#include "tests/tools/export/lit_scene.h"

#include <doctest/doctest.h>

#include <cstring>
#include <map>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

const LitScene& lit_scene() {
  static const LitScene lit = make_lit_scene();
  return lit;
}

// A point as its bits, to be told from all others.
std::array<uint32_t, 3> point_bits(Vec3 p) {
  std::array<uint32_t, 3> bits;
  std::memcpy(bits.data(), &p, sizeof bits);
  return bits;
}

double triangle_area(const LitMesh& mesh, const std::array<uint32_t, 3>& corner) {
  const DVec3 a(mesh.position[corner[0]]), b(mesh.position[corner[1]]), c(mesh.position[corner[2]]);
  return 0.5 * length(cross(b - a, c - a));
}

// The length of a polygon's border, holes included.
double find_perimeter(const FaceTable& faces, uint32_t polygon) {
  const FaceLinkTable links = make_face_links(faces);
  double sum = 0;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (uint32_t k = 0; k < faces.corner_count[f]; ++k)
      if (faces.polygon[f] == polygon && links.edge[f][k].face == kNone)
        sum += distance(DVec3(faces.corners[f][k]), DVec3(faces.corners[f][(k + 1) % faces.corner_count[f]]));
  return sum;
}

// Every edge of a polygon's triangles, by the bits of its ends, is run once, and the other way once by a
// neighbour; where there is none it lies on the border. A corner that lay on another triangle's edge would
// leave three edges without a neighbour, and the border would be too long.
void check_watertight(const LitScene& lit, const LitMesh& mesh) {
  const TriangleTable triangles = make_triangles(mesh);
  using Edge = std::pair<std::array<uint32_t, 3>, std::array<uint32_t, 3>>;
  for (uint32_t polygon = 0; polygon < lit.scene.polygons.size(); ++polygon) {
    std::map<Edge, double> edges;
    for (uint32_t t = triangles.polygon_first[polygon]; t < triangles.polygon_first[polygon + 1]; ++t)
      for (size_t k = 0; k < 3; ++k) {
        const Vec3 from = mesh.position[triangles.corner[t][k]],
                   to = mesh.position[triangles.corner[t][(k + 1) % 3]];
        const bool fresh =
            edges.try_emplace({point_bits(from), point_bits(to)}, distance(DVec3(from), DVec3(to))).second;
        CHECK(fresh);
      }
    double border = 0;
    for (const auto& [edge, size] : edges)
      if (!edges.contains({edge.second, edge.first})) border += size;
    // Corners are rounded to floats: 6e-8 each, hundreds of them on a border of length 1.
    CHECK(border == doctest::Approx(find_perimeter(lit.scene.faces, polygon)).epsilon(1e-5));
  }
}

}  // namespace

TEST_CASE("the triangles of the lit mesh have the area of the scene, and each has some") {
  const LitScene& lit = lit_scene();
  for (const Shading shading : {Shading::kSmooth, Shading::kFlat}) {
    const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, shading);
    const TriangleTable triangles = make_triangles(mesh);
    CHECK(triangles.size() == mesh.triangle_count());
    std::vector<double> area(lit.solution.mesh.elements.size(), 0);
    for (size_t t = 0; t < triangles.size(); ++t) {
      const double part = triangle_area(mesh, triangles.corner[t]);
      CHECK(part > 0.1 * lit.solution.mesh.elements.area[triangles.element[t]]);
      area[triangles.element[t]] += part;
    }
    // Leaves have edges of 1e-2 and more, and corners are rounded to 6e-8.
    for (size_t row = 0; row < area.size(); ++row)
      CHECK(area[row] == doctest::Approx(lit.solution.mesh.elements.area[row]).epsilon(1e-4));
  }
}

TEST_CASE("the lit mesh of a polygon has no cracks: two triangles an inner edge, also where corners hang") {
  const LitScene& lit = lit_scene();
  REQUIRE(lit.solution.mesh.element_vertices.hanging_order.size() > 50);
  for (const Shading shading : {Shading::kSmooth, Shading::kFlat})
    check_watertight(lit, make_lit_mesh(lit.scene, lit.solution, shading));
}

TEST_CASE("every corner that hangs is in the outline of the leaf on whose edge it lies") {
  const LitScene& lit = lit_scene();
  const VertexTable& vertices = lit.solution.mesh.element_vertices;
  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kSmooth);
  std::vector<uint32_t> outline_count(vertices.size(), 0);
  for (const uint32_t vertex : mesh.outline) ++outline_count[mesh.source[vertex]];
  for (uint32_t v = 0; v < vertices.size(); ++v) {
    const uint32_t leaf_count = vertices.vertex_first[v + 1] - vertices.vertex_first[v];
    const bool hangs = vertices.hanging_between[v][0] != kNone;
    CHECK(outline_count[v] == leaf_count + (hangs ? 1 : 0));
  }
}

TEST_CASE("smooth: one vertex a corner and polygon, with the value and the place of vertex_radiosity's") {
  const LitScene& lit = lit_scene();
  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kSmooth);
  const std::vector<Rgb> values = vertex_radiosity(lit.solution);
  std::vector<std::vector<uint32_t>> rows(values.size());
  for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    CHECK(mesh.radiosity[v] == values[mesh.source[v]]);
    rows[mesh.source[v]].push_back(v);
  }
  size_t shared = 0;
  for (const std::vector<uint32_t>& row : rows) {
    REQUIRE(!row.empty());
    // The two facets share the corners between them, and nothing else is shared.
    if (row.size() == 2) ++shared;
    CHECK(row.size() <= 2);
    for (const uint32_t v : row) CHECK(point_bits(mesh.position[v]) == point_bits(mesh.position[row[0]]));
  }
  CHECK(shared >= 2);
}

TEST_CASE("flat: a leaf has vertices of its own, with its own radiosity") {
  const LitScene& lit = lit_scene();
  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kFlat);
  CHECK(mesh.vertex_count() == mesh.outline.size());
  for (size_t row = 0; row < lit.solution.mesh.elements.size(); ++row)
    for (uint32_t k = mesh.outline_first[row]; k < mesh.outline_first[row + 1]; ++k) {
      CHECK(mesh.source[mesh.outline[k]] == row);
      CHECK(mesh.radiosity[mesh.outline[k]] == lit.solution.mesh.elements.radiosity[row]);
    }
}

TEST_CASE("a polygon has a range of vertices and one of leaves, and its triangles face its lit side") {
  const LitScene& lit = lit_scene();
  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kSmooth);
  const TriangleTable triangles = make_triangles(mesh);
  const std::vector<Vec3> normals = find_polygon_normals(lit.scene);
  CHECK(mesh.vertex_first.back() == mesh.vertex_count());
  CHECK(mesh.element_first.back() == lit.solution.mesh.elements.size());
  for (uint32_t polygon = 0; polygon < lit.scene.polygons.size(); ++polygon) {
    for (uint32_t row = mesh.element_first[polygon]; row < mesh.element_first[polygon + 1]; ++row)
      CHECK(lit.scene.faces.polygon[lit.solution.mesh.elements.face[row]] == polygon);
    for (uint32_t t = triangles.polygon_first[polygon]; t < triangles.polygon_first[polygon + 1]; ++t) {
      const auto [a, b, c] = triangles.corner[t];
      for (const uint32_t v : triangles.corner[t]) {
        CHECK(v >= mesh.vertex_first[polygon]);
        CHECK(v < mesh.vertex_first[polygon + 1]);
      }
      const Vec3 across = cross(mesh.position[b] - mesh.position[a], mesh.position[c] - mesh.position[a]);
      CHECK(dot(across, normals[polygon]) > 0.99f * length(across));
    }
  }
}

TEST_CASE("corners of faces are exact in the lit mesh") {
  const LitScene& lit = lit_scene();
  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kSmooth);
  std::map<std::array<uint32_t, 3>, uint32_t> places;
  for (const Vec3& p : mesh.position) ++places[point_bits(p + 0.0f)];
  for (uint32_t f = 0; f < lit.scene.faces.size(); ++f)
    for (uint32_t k = 0; k < lit.scene.faces.corner_count[f]; ++k)
      CHECK(places.contains(point_bits(lit.scene.faces.corners[f][k] + 0.0f)));
}

TEST_CASE("polygons whose ids differ in their last part are one thing") {
  PolygonTable polygons;
  polygons.id = {"hall.floor", "lamp",   "hall.ceiling", "chairs[0].2",     "chairs[0].3", "chairs[1].2",
                 "tubes[0,1]", "screen", "screen.back",  "hall.floor.back", "tubes[1,0]",  "hall.back"};
  const ThingTable things = find_things(polygons);
  CHECK(things.name == std::vector<std::string>{"hall", "lamp", "chairs[0]", "chairs[1]", "tubes", "screen"});
  CHECK(things.first == std::vector<uint32_t>{0, 4, 5, 7, 8, 10, 12});
  CHECK(things.polygon == std::vector<uint32_t>{0, 2, 9, 11, 1, 3, 4, 5, 6, 10, 7, 8});
}
