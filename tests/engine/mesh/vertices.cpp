#include "engine/mesh/vertices.h"

#include "engine/base/sampling.h"
#include "engine/mesh/face_links.h"
#include "tests/scenes.h"

#include <doctest/doctest.h>

#include <map>

using namespace patchlight;

namespace {

struct Leaves {
  FaceTable faces;
  FaceFrameTable frames;
  FaceLinkTable links;
  PatchTable leaves;
  VertexTable vertices;
};

Leaves make_mesh(FaceTable faces, uint32_t level, uint32_t split_rounds, uint64_t seed) {
  Leaves mesh{std::move(faces), {}, {}, {}, {}};
  mesh.frames = make_face_frames(mesh.faces);
  mesh.links = make_face_links(mesh.faces);
  mesh.leaves = make_leaves(mesh.faces, mesh.frames, [&](uint32_t) { return level; });
  split_at_random(mesh.leaves, mesh.frames, mesh.links, split_rounds, seed);
  mesh.vertices = make_vertices(mesh.leaves, mesh.frames, mesh.links);
  return mesh;
}

Vec3 corner_point(const Leaves& mesh, uint32_t row, uint32_t k) {
  return cell_corners(mesh.frames, mesh.leaves.face[row], mesh.leaves.cell[row], mesh.leaves.level[row])[k];
}

Vec3 centre_point(const Leaves& mesh, uint32_t row) {
  return cell_centre(mesh.frames, mesh.leaves.face[row], mesh.leaves.cell[row], mesh.leaves.level[row]);
}

std::vector<Rgb> make_random_values(size_t count) {
  std::vector<Rgb> values(count);
  for (uint32_t k = 0; k < count; ++k) {
    const Vec2 a = make_jitter(1, k), b = make_jitter(2, k);
    values[k] = {a.x, 10 * a.y, b.x};
  }
  return values;
}

float sample_at(const Leaves& mesh, const std::vector<Rgb>& values, uint32_t row, Vec3 point) {
  const Vec2 uv = find_face_parameters(mesh.frames, mesh.leaves.face[row], point);
  return sample_surface({mesh.vertices, mesh.leaves, mesh.frames}, values, row, uv).r;
}

constexpr ReconstructSettings kPlain{.sharpen_steps = 0, .border_steps = 0};
constexpr ReconstructSettings kSharp{.sharpen_steps = 3, .border_steps = 3};

}  // namespace

TEST_CASE("corners at one place are one vertex, and others are not") {
  const Leaves mesh = make_mesh(make_mixed_polygon({}), 1, 5, 4);
  std::map<std::array<int, 2>, uint32_t> vertex_at;
  std::vector<uint8_t> met(mesh.vertices.size(), 0);
  for (uint32_t row = 0; row < mesh.leaves.size(); ++row)
    for (uint32_t k = 0; k < edge_count(mesh.frames, mesh.leaves.face[row]); ++k) {
      const Vec3 p = corner_point(mesh, row, k);
      const uint32_t vertex = mesh.vertices.leaf_vertex[row][k];
      // Cells are at least 1/64 of an edge in size; equal corners differ by rounding.
      const std::array<int, 2> place = {static_cast<int>(std::lround(p.x * 4096)),
                                        static_cast<int>(std::lround(p.y * 4096))};
      REQUIRE(vertex_at.try_emplace(place, vertex).first->second == vertex);
      met[vertex] = 1;
    }
  CHECK(vertex_at.size() == mesh.vertices.size());
  CHECK(std::count(met.begin(), met.end(), 1) == static_cast<std::ptrdiff_t>(met.size()));
}

TEST_CASE("a triangle repeats its third vertex, and the list of leaves of a vertex is the inverse") {
  const Leaves mesh = make_mesh(make_mixed_polygon({}), 1, 4, 5);
  size_t entries = 0;
  for (uint32_t v = 0; v < mesh.vertices.size(); ++v)
    for (uint32_t k = mesh.vertices.vertex_first[v]; k < mesh.vertices.vertex_first[v + 1]; ++k, ++entries) {
      const auto& corner = mesh.vertices.leaf_vertex[mesh.vertices.vertex_leaf[k]];
      REQUIRE(std::count(corner.begin(), corner.end(), v) >= 1);
    }
  size_t expected = 0;
  for (uint32_t row = 0; row < mesh.leaves.size(); ++row) {
    expected += edge_count(mesh.frames, mesh.leaves.face[row]);
    if (mesh.frames.triangle[mesh.leaves.face[row]])
      CHECK(mesh.vertices.leaf_vertex[row][2] == mesh.vertices.leaf_vertex[row][3]);
  }
  CHECK(entries == expected);
}

TEST_CASE("polygons that touch share no vertices") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  add_quad(faces, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {});
  CHECK(make_mesh(faces, 1, 0, 0).vertices.size() == 18);
  faces.polygon[1] = 0;
  CHECK(make_mesh(faces, 1, 0, 0).vertices.size() == 15);
}

TEST_CASE("the surface of values has no cracks: both sides of every edge agree along it") {
  for (const uint64_t seed : {1u, 2u}) {
    const Leaves mesh = make_mesh(make_mixed_polygon({}), 1, 5, seed);
    CHECK(!mesh.vertices.hanging_order.empty());
    for (const ReconstructSettings& settings : {kPlain, kSharp}) {
      const auto values = reconstruct({mesh.vertices, mesh.leaves, mesh.frames},
                                      make_random_values(mesh.leaves.size()), settings);
      for (uint32_t row = 0; row < mesh.leaves.size(); ++row)
        for (uint32_t edge = 0; edge < edge_count(mesh.frames, mesh.leaves.face[row]); ++edge) {
          const uint32_t other = find_coarse_neighbour(mesh.leaves, mesh.frames, mesh.links, row, edge);
          if (other == kNone) continue;
          const Vec3 a = corner_point(mesh, row, edge);
          const Vec3 b = corner_point(mesh, row, (edge + 1) % edge_count(mesh.frames, mesh.leaves.face[row]));
          for (const float t : {0.0f, 0.25f, 0.5f, 0.9f, 1.0f}) {
            const Vec3 p = a + t * (b - a);
            // Values up to 1 over cells of 1/64: parameters known to 2^-22 or so.
            REQUIRE(std::abs(sample_at(mesh, values, row, p) - sample_at(mesh, values, other, p)) <= 1e-4f);
          }
        }
    }
  }
}

TEST_CASE("a hanging vertex is the mean of the ends of the edge that it hangs on") {
  const Leaves mesh = make_mesh(make_mixed_polygon({}), 1, 5, 8);
  const auto values =
      reconstruct({mesh.vertices, mesh.leaves, mesh.frames}, make_random_values(mesh.leaves.size()), kSharp);
  std::vector<Vec3> place(mesh.vertices.size());
  for (uint32_t row = 0; row < mesh.leaves.size(); ++row)
    for (uint32_t k = 0; k < 4; ++k) place[mesh.vertices.leaf_vertex[row][k]] = corner_point(mesh, row, k);
  size_t hanging = 0;
  for (uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto [a, b] = mesh.vertices.hanging_between[v];
    if (a == kNone) continue;
    ++hanging;
    CHECK(distance(place[v], 0.5f * (place[a] + place[b])) <= 1e-5f);
    CHECK(values[v] == 0.5f * (values[a] + values[b]));
  }
  CHECK(hanging == mesh.vertices.hanging_order.size());
}

TEST_CASE("equal leaves give an equal surface, whatever the mesh and the settings") {
  const Leaves mesh = make_mesh(make_mixed_polygon({}), 1, 5, 6);
  const std::vector<Rgb> leaf_values(mesh.leaves.size(), Rgb(0.3f, 7, 1e-6f));
  for (const ReconstructSettings& settings : {kPlain, kSharp})
    for (const Rgb& value : reconstruct({mesh.vertices, mesh.leaves, mesh.frames}, leaf_values, settings)) {
      // Sums of up to eight equal floats.
      CHECK(value.r == doctest::Approx(0.3f).epsilon(1e-6));
      CHECK(value.g == doctest::Approx(7).epsilon(1e-6));
      CHECK(value.b == doctest::Approx(1e-6).epsilon(1e-6));
    }
}

TEST_CASE("a linear field on a uniform mesh is reproduced at inner vertices") {
  FaceTable quad, triangle;
  add_quad(quad, {0, 0, 0}, {2, 0, 0}, {2.5f, 1, 0}, {0.5f, 1, 0}, {});
  add_triangle(triangle, {0, 0, 0}, {2, 0, 0}, {0.5f, 1, 0}, {});
  for (const FaceTable& faces : {quad, triangle}) {
    const Leaves mesh = make_mesh(faces, 4, 0, 0);
    const auto field = [](Vec3 p) { return 3 + p.x - 0.7f * p.y; };
    std::vector<Rgb> leaf_values(mesh.leaves.size());
    for (uint32_t row = 0; row < mesh.leaves.size(); ++row)
      leaf_values[row] = Rgb(field(centre_point(mesh, row)));
    const auto plain = reconstruct({mesh.vertices, mesh.leaves, mesh.frames}, leaf_values, kPlain);
    const auto border = reconstruct({mesh.vertices, mesh.leaves, mesh.frames}, leaf_values,
                                    {.sharpen_steps = 0, .border_steps = 2});
    size_t inner = 0;
    double plain_error = 0, border_error = 0;
    for (uint32_t row = 0; row < mesh.leaves.size(); ++row)
      for (uint32_t k = 0; k < edge_count(mesh.frames, mesh.leaves.face[row]); ++k) {
        const uint32_t v = mesh.vertices.leaf_vertex[row][k];
        const float expected = field(corner_point(mesh, row, k));
        if (mesh.vertices.border[v]) {
          plain_error += std::abs(plain[v].r - expected);
          border_error += std::abs(border[v].r - expected);
          continue;
        }
        ++inner;
        // Leaves lie in point symmetry about an inner vertex; sums of six floats up to 5.
        CHECK(std::abs(plain[v].r - expected) <= 5e-6f);
        CHECK(std::abs(border[v].r - expected) <= 5e-6f);
      }
    CHECK(inner > 100);
    // On the border the plain mean flattens the slope; two steps take most of that away.
    CHECK(border_error < 0.5 * plain_error);
  }
}

TEST_CASE("values stay within those of the leaves around an inner vertex, and are never negative") {
  const Leaves mesh = make_mesh(make_mixed_polygon({}), 2, 4, 7);
  auto leaf_values = make_random_values(mesh.leaves.size());
  for (uint32_t row = 0; row < leaf_values.size(); row += 3) leaf_values[row] = Rgb(0);  // sharp edges
  for (const ReconstructSettings& settings :
       {kPlain, kSharp, ReconstructSettings{.sharpen_steps = 20, .border_steps = 20}}) {
    const auto values = reconstruct({mesh.vertices, mesh.leaves, mesh.frames}, leaf_values, settings);
    for (uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      REQUIRE(values[v].r >= 0);
      REQUIRE(values[v].g >= 0);
      if (mesh.vertices.border[v] || mesh.vertices.hanging_between[v][0] != kNone) continue;
      float least = 1e30f, most = 0;
      for (uint32_t k = mesh.vertices.vertex_first[v]; k < mesh.vertices.vertex_first[v + 1]; ++k) {
        least = std::min(least, leaf_values[mesh.vertices.vertex_leaf[k]].g);
        most = std::max(most, leaf_values[mesh.vertices.vertex_leaf[k]].g);
      }
      // A mean of floats may round past its largest one.
      REQUIRE(values[v].g >= least * (1 - 1e-6f));
      REQUIRE(values[v].g <= most * (1 + 1e-6f));
    }
  }
}

TEST_CASE("sharpening brings the mean of the surface over a leaf nearer to the leaf's value") {
  const Leaves mesh = make_mesh(make_mixed_polygon({}), 4, 0, 0);
  std::vector<Rgb> leaf_values(mesh.leaves.size());
  for (uint32_t row = 0; row < mesh.leaves.size(); ++row)
    leaf_values[row] = Rgb(centre_point(mesh, row).x + 0.3f * centre_point(mesh, row).y > 0.5f ? 1.0f : 0.2f);
  double error[2] = {0, 0};
  for (int sharp = 0; sharp < 2; ++sharp) {
    const auto values =
        reconstruct({mesh.vertices, mesh.leaves, mesh.frames}, leaf_values, sharp ? kSharp : kPlain);
    for (uint32_t row = 0; row < mesh.leaves.size(); ++row) {
      const auto& c = mesh.vertices.leaf_vertex[row];
      const float three = values[c[0]].r + values[c[1]].r + values[c[2]].r;
      const bool triangle = mesh.frames.triangle[mesh.leaves.face[row]];
      error[sharp] += std::abs((triangle ? three / 3 : (three + values[c[3]].r) / 4) - leaf_values[row].r);
    }
  }
  CHECK(error[1] < error[0]);
}

TEST_CASE("leaves that lie buried do not count, and a vertex among them alone is black") {
  Leaves mesh = make_mesh(make_mixed_polygon({}), 3, 0, 0);
  std::vector<Rgb> leaf_values(mesh.leaves.size(), Rgb(2));
  for (uint32_t row = 0; row < mesh.leaves.face_first[1]; ++row)
    if (centre_point(mesh, row).x < 0.5f) mesh.leaves.exposed[row] = 0, leaf_values[row] = Rgb(1000);
  const auto values = reconstruct({mesh.vertices, mesh.leaves, mesh.frames}, leaf_values, kSharp);
  for (uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    bool any = false;
    for (uint32_t k = mesh.vertices.vertex_first[v]; k < mesh.vertices.vertex_first[v + 1]; ++k)
      any |= mesh.leaves.exposed[mesh.vertices.vertex_leaf[k]] > 0;
    CHECK(values[v].r == doctest::Approx(any ? 2 : 0).epsilon(1e-6));
  }
}
