// Leaves and their shared corners -> outlines with every corner that lies on them.
//
// Hanging corners become corners of the coarse side's outline (Baum, Mann, Smith, Winget: Making Radiosity
// Usable, 1991), so that any program may draw the triangles.
#include "tools/export/lit_mesh.h"

#include "engine/base/parallel.h"
#include "engine/mesh/quadtree.h"

#include <algorithm>
#include <cassert>
#include <unordered_map>
#include <unordered_set>

namespace patchlight {
namespace {

constexpr size_t kOutlineMax = 8;  // four corners and one between each two

// A few vertices, in place.
struct Ring {
  std::array<uint32_t, kOutlineMax> vertex;
  size_t count = 0;
  void push(uint32_t v) { vertex[count++] = v; }
};

// In double from the face's corners, whose weights are 0 and 1 at the corners themselves: there it is exact.
Vec3 find_vertex_position(const Solution& s, const FaceTable& faces, uint32_t vertex) {
  const uint32_t row = s.mesh.element_vertices.vertex_leaf[s.mesh.element_vertices.vertex_first[vertex]];
  const auto& corner = s.mesh.element_vertices.leaf_vertex[row];
  const auto k = static_cast<size_t>(std::find(corner.begin(), corner.end(), vertex) - corner.begin());
  const uint32_t face = s.mesh.elements.face[row];
  const bool triangle = s.surfaces->frames.triangle[face];
  const DVec2 uv(cell_corner_parameters(triangle, s.mesh.elements.cell[row], s.mesh.elements.level[row])[k]);
  const auto& p = faces.corners[face];
  const DVec3 a(p[0]), b(p[1]), c(p[2]), d(p[3]);
  if (triangle) return Vec3((1 - uv.x - uv.y) * a + uv.x * b + uv.y * c);
  return Vec3((1 - uv.y) * ((1 - uv.x) * a + uv.x * b) + uv.y * ((1 - uv.x) * d + uv.x * c));
}

// The corner in the middle of a leaf's edge that two finer neighbours share, or kNone.
uint32_t find_hanging(const Solution& s, uint32_t row, uint32_t edge, uint32_t from, uint32_t to) {
  const auto across =
      find_neighbours(s.mesh.elements, s.surfaces->frames, s.surfaces->smooth_links, row, edge);
  if (across[1] == kNone) return kNone;
  for (const uint32_t vertex : s.mesh.element_vertices.leaf_vertex[across[0]]) {
    const auto [a, b] = s.mesh.element_vertices.hanging_between[vertex];
    if ((a == from && b == to) || (a == to && b == from)) return vertex;
  }
  assert(!"two finer neighbours share a corner that hangs on the edge");
  return kNone;
}

float find_triangle_area(Vec3 a, Vec3 b, Vec3 c) { return 0.5f * length(cross(b - a, c - a)); }

// True where a quad is better cut from its second corner to its last than from its first to its third: where
// that leaves no thin triangle; else along equal light, which bends the surface of values least.
bool is_cut_at_second(const Ring& quad, std::span<const Vec3> position, std::span<const Rgb> values) {
  const auto at = [&](size_t k) { return position[quad.vertex[k]]; };
  const float first =
      std::min(find_triangle_area(at(0), at(1), at(2)), find_triangle_area(at(0), at(2), at(3)));
  const float second =
      std::min(find_triangle_area(at(1), at(2), at(3)), find_triangle_area(at(1), at(3), at(0)));
  if (std::min(first, second) < 0.5f * std::max(first, second)) return second > first;
  const auto light = [&](size_t k) { return luminance(values[quad.vertex[k]]); };
  return std::abs(light(1) - light(3)) < std::abs(light(0) - light(2));
}

// The outline of a leaf, of vertices of the solution, turned so that the fan from its first cuts it well. A
// fan from the middle of an edge has no triangle without area: that edge's ends are the fan's, too.
Ring find_outline(const Solution& s, uint32_t row, std::span<const Vec3> position,
                  std::span<const Rgb> values) {
  const auto& corner = s.mesh.element_vertices.leaf_vertex[row];
  const uint32_t edges = edge_count(s.surfaces->frames, s.mesh.elements.face[row]);
  Ring ring;
  size_t first = 0;
  for (uint32_t k = 0; k < edges; ++k) {
    const uint32_t from = corner[k], to = corner[(k + 1) % edges];
    ring.push(from);
    const uint32_t hanging = find_hanging(s, row, k, from, to);
    if (hanging == kNone) continue;
    first = ring.count;
    ring.push(hanging);
  }
  if (ring.count == 4 && edges == 4 && is_cut_at_second(ring, position, values)) first = 1;
  std::rotate(ring.vertex.begin(), ring.vertex.begin() + static_cast<std::ptrdiff_t>(first),
              ring.vertex.begin() + static_cast<std::ptrdiff_t>(ring.count));
  return ring;
}

using IdSet = std::unordered_set<std::string_view>;

// The id without its last part: .NAME or [...]. The other side of a polygon is a part of the same thing; a
// room has a wall called back, too.
std::string_view find_thing_name(std::string_view id, const IdSet& ids) {
  constexpr std::string_view kBack = ".back";
  if (id.ends_with(kBack) && ids.contains(id.substr(0, id.size() - kBack.size())))
    id.remove_suffix(kBack.size());
  const size_t cut = id.find_last_of(".[");
  return cut == std::string_view::npos || cut == 0 ? id : id.substr(0, cut);
}

}  // namespace

LitMesh make_lit_mesh(const Scene& scene, const Solution& s, Shading shading) {
  assert(s.mesh.frozen);
  const FaceTable& faces = scene.faces;
  const bool smooth = shading == Shading::kSmooth;
  const size_t leaf_count = s.mesh.elements.size(), vertex_count = s.mesh.element_vertices.size();
  const std::vector<Rgb> values = vertex_radiosity(s, find_shown_ambient(scene, s));
  std::vector<Vec3> position(vertex_count);
  for_rows(vertex_count, 4096, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v)
      position[v] = find_vertex_position(s, faces, static_cast<uint32_t>(v));
  });
  std::vector<Ring> rings(leaf_count);
  for_rows(leaf_count, 2048, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row)
      rings[row] = find_outline(s, static_cast<uint32_t>(row), position, values);
  });

  LitMesh mesh;
  // In the order in which outlines name them, so that a vertex is near its neighbours in memory.
  const auto add_vertex = [&](uint32_t v, uint32_t row) {
    mesh.position.push_back(position[v]);
    mesh.radiosity.push_back(smooth ? values[v] : s.mesh.elements.radiosity[row]);
    mesh.source.push_back(smooth ? v : row);
    return static_cast<uint32_t>(mesh.position.size() - 1);
  };
  std::vector<uint32_t> row_of(vertex_count, 0), polygon_of(vertex_count, kNone);
  mesh.outline_first.push_back(0);
  uint32_t row = 0;
  for (uint32_t polygon = 0; polygon < scene.polygons.size(); ++polygon) {
    mesh.vertex_first.push_back(static_cast<uint32_t>(mesh.position.size()));
    mesh.element_first.push_back(row);
    for (; row < leaf_count && faces.polygon[s.mesh.elements.face[row]] == polygon; ++row) {
      for (size_t k = 0; k < rings[row].count; ++k) {
        const uint32_t v = rings[row].vertex[k];
        if (!smooth || polygon_of[v] != polygon) row_of[v] = add_vertex(v, row), polygon_of[v] = polygon;
        mesh.outline.push_back(row_of[v]);
      }
      mesh.outline_first.push_back(static_cast<uint32_t>(mesh.outline.size()));
    }
  }
  assert(row == leaf_count);
  mesh.vertex_first.push_back(static_cast<uint32_t>(mesh.position.size()));
  mesh.element_first.push_back(row);
  return mesh;
}

TriangleTable make_triangles(const LitMesh& mesh) {
  TriangleTable triangles;
  triangles.corner.reserve(mesh.triangle_count());
  triangles.element.reserve(mesh.triangle_count());
  for (size_t polygon = 0; polygon + 1 < mesh.element_first.size(); ++polygon) {
    triangles.polygon_first.push_back(static_cast<uint32_t>(triangles.size()));
    for (uint32_t row = mesh.element_first[polygon]; row < mesh.element_first[polygon + 1]; ++row) {
      const uint32_t first = mesh.outline_first[row], last = mesh.outline_first[row + 1];
      for (uint32_t k = first + 1; k + 1 < last; ++k) {
        triangles.corner.push_back({mesh.outline[first], mesh.outline[k], mesh.outline[k + 1]});
        triangles.element.push_back(row);
      }
    }
  }
  triangles.polygon_first.push_back(static_cast<uint32_t>(triangles.size()));
  return triangles;
}

std::vector<Vec3> find_polygon_normals(const Scene& scene) {
  const FaceTable& faces = scene.faces;
  std::vector<Vec3> normals;
  for (size_t polygon = 0; polygon < scene.polygons.size(); ++polygon) {
    DVec3 sum(0);
    for (uint32_t f = scene.polygons.face_first[polygon]; f < scene.polygons.face_first[polygon + 1]; ++f) {
      const auto& p = faces.corners[f];
      sum += length(cross(DVec3(p[2]) - DVec3(p[0]), DVec3(p[3]) - DVec3(p[1]))) * DVec3(faces.normal[f]);
    }
    normals.push_back(Vec3(normalize(sum)));
  }
  return normals;
}

ThingTable find_things(const PolygonTable& polygons) {
  const IdSet ids(polygons.id.begin(), polygons.id.end());
  ThingTable things;
  std::unordered_map<std::string_view, uint32_t> known;
  std::vector<uint32_t> thing_of(polygons.size());
  for (size_t polygon = 0; polygon < polygons.size(); ++polygon) {
    const std::string_view name = find_thing_name(polygons.id[polygon], ids);
    const auto [at, fresh] = known.try_emplace(name, static_cast<uint32_t>(things.size()));
    if (fresh) things.name.emplace_back(name);
    thing_of[polygon] = at->second;
  }
  things.first.assign(things.size() + 1, 0);
  for (const uint32_t thing : thing_of) ++things.first[thing + 1];
  for (size_t k = 0; k < things.size(); ++k) things.first[k + 1] += things.first[k];
  things.polygon.resize(polygons.size());
  std::vector<uint32_t> next(things.first.begin(), things.first.end() - 1);
  for (uint32_t polygon = 0; polygon < polygons.size(); ++polygon)
    things.polygon[next[thing_of[polygon]]++] = polygon;
  return things;
}

}  // namespace patchlight
