// The lit mesh as PLY, read back.
#include "lit_scene.h"
#include "tests/folder.h"
#include "tools/exporters.h"
#include "tools/exposure.h"
#include "tools/lit_mesh.h"

#include <doctest/doctest.h>

#include <cstring>

using namespace patchlight;
using namespace patchlight::testing;

TEST_CASE(
    "a PLY file holds vertices in the file's units, with shown colours and radiosity, and triangles with "
    "patches") {
  const LitScene lit = make_lit_scene();
  const Folder folder;
  NewFile file;
  open_file(file, folder / "s.ply");
  export_ply(file, lit.scene, lit.solution);
  commit_file(file);
  const std::string bytes = read_bytes(folder / "s.ply");

  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kSmooth);
  const TriangleTable triangles = make_triangles(mesh);
  const std::string end = "end_header\n";
  const size_t start = bytes.find(end) + end.size();
  const std::string header = bytes.substr(0, start);
  CHECK(header.starts_with("ply\nformat binary_little_endian 1.0\n"));
  CHECK(header.find("element vertex " + std::to_string(mesh.vertex_count()) + "\n") != std::string::npos);
  CHECK(header.find("element face " + std::to_string(triangles.size()) + "\n") != std::string::npos);

#pragma pack(push, 1)
  struct Vertex {
    float position[3], normal[3];
    uint8_t color[3];
    float radiosity[3];
  };
  struct Face {
    uint8_t count;
    uint32_t corner[3], patch;
  };
#pragma pack(pop)
  REQUIRE(bytes.size() == start + mesh.vertex_count() * sizeof(Vertex) + triangles.size() * sizeof(Face));
  const char* at = bytes.data() + start;
  const std::vector<Vec3> normals = find_polygon_normals(lit.scene);
  for (uint32_t v = 0, polygon = 0; v < mesh.vertex_count(); ++v, at += sizeof(Vertex)) {
    while (v >= mesh.vertex_first[polygon + 1]) ++polygon;
    Vertex vertex;
    std::memcpy(&vertex, at, sizeof vertex);
    for (int k = 0; k < 3; ++k) {
      // 250 cm a length, from (1000, 0, -50).
      const double place = lit.scene.origin[k] + 250.0 * static_cast<double>(mesh.position[v][k]);
      CHECK(vertex.position[k] == static_cast<float>(place));
      CHECK(vertex.normal[k] == normals[polygon][k]);
      CHECK(vertex.radiosity[k] == mesh.radiosity[v][k]);
      // EV -1: half of it is shown.
      CHECK(std::abs(vertex.color[k] - 255 * encode_srgb(std::min(mesh.radiosity[v][k] / 2, 1.0f))) <=
            0.501f);
    }
  }
  for (size_t t = 0; t < triangles.size(); ++t, at += sizeof(Face)) {
    Face face;
    std::memcpy(&face, at, sizeof face);
    CHECK(face.count == 3);
    for (size_t k = 0; k < 3; ++k) CHECK(face.corner[k] == triangles.corner[t][k]);
    CHECK(face.patch == triangles.element[t]);
  }
}
