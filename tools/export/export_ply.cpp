// The lit mesh -> S.ply: binary, little endian, in the file's units.
//
// red, green, blue are what a display shows (sRGB by the run's exposure), as readers of the format expect
// them; radiosity_r, _g, _b are the light itself, W/m2. A face's `patch` is its row in S-patches.csv, from 0.
#include "tools/base/bytes.h"
#include "tools/base/version.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"
#include "tools/image/exposure.h"
#include "tools/image/srgb.h"

#include <fmt/format.h>

#include <cmath>

namespace patchlight {
namespace {

constexpr size_t kChunkBytes = size_t{1} << 20;

std::string make_header(const FinishedRun& run, size_t vertex_count, size_t triangle_count) {
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment patchlight {}; lengths in {}; exposure EV {:.2f}; radiosity in W/m2\n"
      "element vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float radiosity_r\nproperty float radiosity_g\nproperty float radiosity_b\n"
      "element face {}\n"
      "property list uchar uint vertex_indices\n"
      "property uint patch\n"
      "end_header\n",
      version_number(), run.scene.units, *run.report.exposure_ev, vertex_count, triangle_count);
}

}  // namespace

void export_ply(NewFile& file, const FinishedRun& run) {
  const Scene& scene = run.scene;
  const LitMesh mesh = make_lit_mesh(scene, run.solution, scene.output.shading);
  const TriangleTable triangles = make_triangles(mesh);
  const std::vector<Vec3> normals = find_polygon_normals(scene);
  const std::vector<Rgb> shown = expose_values(mesh.radiosity, *run.report.exposure_ev);
  std::string bytes = make_header(run, mesh.vertex_count(), triangles.size());
  const auto flush_if = [&](bool due) {
    if (!due) return;
    append_file(file, bytes);
    bytes.clear();
  };
  for (size_t polygon = 0; polygon < normals.size(); ++polygon)
    for (uint32_t v = mesh.vertex_first[polygon]; v < mesh.vertex_first[polygon + 1]; ++v) {
      put_bytes(bytes, Vec3(to_file_units(scene, mesh.position[v])));
      put_bytes(bytes, normals[polygon]);
      for (int k = 0; k < 3; ++k)
        put_bytes(bytes, static_cast<uint8_t>(std::lround(255 * encode_srgb(shown[v][k]))));
      put_bytes(bytes, mesh.radiosity[v]);
      flush_if(bytes.size() >= kChunkBytes);
    }
  for (size_t k = 0; k < triangles.size(); ++k) {
    put_bytes(bytes, uint8_t{3});
    put_bytes(bytes, triangles.corner[k]);
    put_bytes(bytes, triangles.element[k]);
    flush_if(bytes.size() >= kChunkBytes);
  }
  flush_if(true);
}

}  // namespace patchlight
