// The lit mesh as PLY, read back.
#include "tests/folder.h"
#include "tests/tools/export/lit_scene.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"
#include "tools/image/exposure.h"
#include "tools/image/srgb.h"

#include <doctest/doctest.h>

#include <array>
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
  find_exporter("ply").export_run(file, lit.finished());
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

  // Nine floats and three bytes a vertex; a byte and four words a face.
  REQUIRE(bytes.size() == start + mesh.vertex_count() * 39 + triangles.size() * 17);
  size_t at = start;
  const auto read = [&](auto& value) {
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
  };
  const std::vector<Vec3> normals = find_polygon_normals(lit.scene);
  for (uint32_t v = 0, polygon = 0; v < mesh.vertex_count(); ++v) {
    while (v >= mesh.vertex_first[polygon + 1]) ++polygon;
    std::array<float, 3> point, normal, radiosity;
    std::array<uint8_t, 3> color;
    read(point), read(normal), read(color), read(radiosity);
    for (size_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      // 250 cm a length, from (1000, 0, -50).
      const double place = lit.scene.origin[axis] + 250.0 * static_cast<double>(mesh.position[v][axis]);
      CHECK(point[k] == static_cast<float>(place));
      CHECK(normal[k] == normals[polygon][axis]);
      CHECK(radiosity[k] == mesh.radiosity[v][axis]);
      // EV -1: half of it is shown.
      CHECK(std::abs(color[k] - 255 * encode_srgb(std::min(mesh.radiosity[v][axis] / 2, 1.0f))) <= 0.501f);
    }
  }
  for (size_t t = 0; t < triangles.size(); ++t) {
    uint8_t count = 0;
    std::array<uint32_t, 3> corner;
    uint32_t patch = 0;
    read(count), read(corner), read(patch);
    CHECK(count == 3);
    CHECK(corner == triangles.corner[t]);
    CHECK(patch == triangles.element[t]);
  }
}
