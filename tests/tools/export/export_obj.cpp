// The lit mesh as OBJ, read back.
#include "tests/folder.h"
#include "tests/tools/export/lit_scene.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"
#include "tools/image/exposure.h"
#include "tools/image/srgb.h"

#include <doctest/doctest.h>

#include <sstream>

using namespace patchlight;
using namespace patchlight::testing;

TEST_CASE("an OBJ file holds an object a thing, a group a polygon, and six numbers a vertex") {
  LitScene lit = make_lit_scene();
  lit.scene.output.shading = Shading::kFlat;
  const Folder folder;
  NewFile file;
  open_file(file, folder / "s.obj");
  find_exporter("obj").export_run(file, lit.finished());
  commit_file(file);

  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kFlat);
  const TriangleTable triangles = make_triangles(mesh);
  const std::vector<Vec3> normals = find_polygon_normals(lit.scene);
  std::istringstream text(read_bytes(folder / "s.obj"));
  size_t vertex = 0, normal = 0, triangle = 0;
  std::string objects, groups;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      REQUIRE(vertex < mesh.vertex_count());
      const DVec3 place = to_file_units(lit.scene, mesh.position[vertex]);
      for (int k = 0; k < 3; ++k) {
        float number = 0;
        words >> number;
        CHECK(number == static_cast<float>(place[k]));
      }
      for (int k = 0; k < 3; ++k) {
        float number = -1;
        words >> number;
        // EV -1; four digits.
        CHECK(std::abs(number - encode_srgb(std::min(mesh.radiosity[vertex][k] / 2, 1.0f))) <= 0.51e-4f);
      }
      ++vertex;
    } else if (word == "vn") {
      REQUIRE(normal < normals.size());
      for (int k = 0; k < 3; ++k) {
        float number = 0;
        words >> number;
        CHECK(number == normals[normal][k]);
      }
      ++normal;
    } else if (word == "o") {
      words >> word;
      objects += word + " ";
    } else if (word == "g") {
      words >> word;
      groups += word + " ";
    } else if (word == "f") {
      REQUIRE(triangle < triangles.size());
      const uint32_t polygon =
          lit.scene.faces.polygon[lit.solution.mesh.elements.face[triangles.element[triangle]]];
      for (const uint32_t corner : triangles.corner[triangle]) {
        words >> word;
        CHECK(word == std::to_string(corner + 1) + "//" + std::to_string(polygon + 1));
      }
      ++triangle;
    } else {
      CHECK(word == "#");
    }
  }
  CHECK(vertex == mesh.vertex_count());
  CHECK(normal == normals.size());
  CHECK(triangle == triangles.size());
  CHECK(objects == "hall lamps plate bowl ");
  CHECK(groups ==
        "hall.floor hall.ceiling hall.left hall.right hall.front hall.back lamps[0] plate bowl.0 bowl.1 ");
}
