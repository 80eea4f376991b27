// The lit mesh as binary glTF, read back. Whether the file keeps to the format is for the format's own
// validator: tests/page/check.mjs.
#include "tests/folder.h"
#include "tests/tools/export/lit_scene.h"
#include "tools/base/json.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"

#include <doctest/doctest.h>

#include <cstring>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

struct GlbFile {
  Json json;
  std::string binary;
};

uint32_t read_word(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  REQUIRE(at + sizeof word <= bytes.size());
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

GlbFile read_glb(const std::string& bytes) {
  CHECK(bytes.substr(0, 4) == "glTF");
  CHECK(read_word(bytes, 4) == 2);
  CHECK(read_word(bytes, 8) == bytes.size());
  const uint32_t text_bytes = read_word(bytes, 12);
  CHECK(bytes.substr(16, 4) == "JSON");
  const size_t binary_at = 20 + text_bytes;
  const uint32_t binary_bytes = read_word(bytes, binary_at);
  CHECK(bytes.substr(binary_at + 4, 4) == std::string("BIN\0", 4));
  CHECK(binary_at + 8 + binary_bytes == bytes.size());
  return {Json::parse(bytes.substr(20, text_bytes)), bytes.substr(binary_at + 8)};
}

// The rows of an accessor, by the type that its reader knows it has.
template <class Row>
std::vector<Row> read_rows(const GlbFile& glb, const Json& accessor) {
  const Json& view = glb.json["bufferViews"][accessor["bufferView"].get<size_t>()];
  const size_t stride = view.contains("byteStride") ? view["byteStride"].get<size_t>() : sizeof(Row);
  const size_t first = view["byteOffset"].get<size_t>() + accessor["byteOffset"].get<size_t>();
  std::vector<Row> rows(accessor["count"].get<size_t>());
  for (size_t k = 0; k < rows.size(); ++k) {
    REQUIRE(first + k * stride + sizeof(Row) <= glb.binary.size());
    std::memcpy(&rows[k], glb.binary.data() + first + k * stride, sizeof(Row));
  }
  return rows;
}

}  // namespace

TEST_CASE(
    "a GLB file holds a node a thing, in metres, with unlit colours of 0 to 1 and radiosity beside them") {
  const LitScene lit = make_lit_scene();
  const Folder folder;
  NewFile file;
  open_file(file, folder / "s.glb");
  find_exporter("glb").export_run(file, lit.finished());
  commit_file(file);
  const GlbFile glb = read_glb(read_bytes(folder / "s.glb"));

  CHECK(glb.json["extensionsUsed"] == Json{"KHR_materials_unlit"});
  CHECK(glb.json["asset"]["extras"]["exposure"] == -1);
  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kSmooth);
  const TriangleTable triangles = make_triangles(mesh);
  const ThingTable things = find_things(lit.scene.polygons);
  const Json& nodes = glb.json["nodes"];
  REQUIRE(nodes.size() == things.size() + 1);  // and the camera
  for (size_t t = 0; t < things.size(); ++t) {
    CHECK(nodes[t]["name"] == things.name[t]);
    const Json& primitive = glb.json["meshes"][nodes[t]["mesh"].get<size_t>()]["primitives"][0];
    const auto accessor = [&](const char* name) -> const Json& {
      return glb.json["accessors"][primitive["attributes"][name].get<size_t>()];
    };
    const auto position = read_rows<std::array<float, 3>>(glb, accessor("POSITION"));
    const auto normal = read_rows<std::array<float, 3>>(glb, accessor("NORMAL"));
    const auto color = read_rows<std::array<uint16_t, 4>>(glb, accessor("COLOR_0"));
    const auto radiosity = read_rows<std::array<float, 3>>(glb, accessor("_RADIOSITY"));
    const auto index = read_rows<uint32_t>(glb, glb.json["accessors"][primitive["indices"].get<size_t>()]);
    const auto centre = nodes[t]["translation"].get<std::array<double, 3>>();
    const std::vector<Vec3> normals = find_polygon_normals(lit.scene);

    size_t row = 0, corner = 0;
    for (uint32_t k = things.first[t]; k < things.first[t + 1]; ++k) {
      const uint32_t polygon = things.polygon[k];
      const auto first_row = static_cast<uint32_t>(row);
      for (uint32_t v = mesh.vertex_first[polygon]; v < mesh.vertex_first[polygon + 1]; ++v, ++row) {
        REQUIRE(row < position.size());
        for (size_t c = 0; c < 3; ++c) {
          const int axis = static_cast<int>(c);
          // Centimetres to metres; floats of a few metres are within 2.4e-7.
          const double metres = to_file_units(lit.scene, mesh.position[v])[axis] * 0.01;
          CHECK(std::abs(centre[c] + position[row][c] - metres) < 2.4e-7);
          CHECK(normal[row][c] == normals[polygon][axis]);
          CHECK(radiosity[row][c] == mesh.radiosity[v][axis]);
          CHECK(std::abs(color[row][c] / 65535.0f - std::min(mesh.radiosity[v][axis] / 2, 1.0f)) < 1e-5f);
        }
        CHECK(color[row][3] == 65535);
      }
      for (uint32_t i = triangles.polygon_first[polygon]; i < triangles.polygon_first[polygon + 1]; ++i)
        for (const uint32_t v : triangles.corner[i]) {
          REQUIRE(corner < index.size());
          CHECK(index[corner++] == v - mesh.vertex_first[polygon] + first_row);
        }
    }
    CHECK(row == position.size());
    CHECK(corner == index.size());
  }
}

TEST_CASE("a GLB file holds the scene's cameras, which look along -z of their nodes") {
  const LitScene lit = make_lit_scene();
  const Folder folder;
  NewFile file;
  open_file(file, folder / "s.glb");
  find_exporter("glb").export_run(file, lit.finished());
  commit_file(file);
  const GlbFile glb = read_glb(read_bytes(folder / "s.glb"));
  const Json& node = glb.json["nodes"].back();
  CHECK(node["camera"] == 0);
  // It looks along -z itself; its eye is at (0.2, 0.1, 0.3) lengths of 2.5 m, from (10, 0, -0.5) m.
  const auto matrix = node["matrix"].get<std::vector<double>>();
  const std::vector<double> expected = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10.5, 0.25, 0.25, 1};
  for (size_t k = 0; k < 16; ++k) CHECK(matrix[k] == doctest::Approx(expected[k]));
  CHECK(glb.json["cameras"][0]["perspective"]["yfov"].get<double>() == doctest::Approx(1.0471976));
  CHECK(glb.json["cameras"][0]["perspective"]["aspectRatio"].get<double>() == doctest::Approx(4 / 3.0));
}
