// The lit mesh -> S.obj: Wavefront OBJ, in the file's units, with six numbers a vertex.
//
// The last three are what a display shows, sRGB 0..1 by the run's exposure, as MeshLab and Blender read and
// write them. An object (o) a thing, a group (g) a polygon.
#include "tools/base/version.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"
#include "tools/image/exposure.h"
#include "tools/image/srgb.h"

#include <fmt/format.h>

#include <charconv>

namespace patchlight {
namespace {

constexpr size_t kChunkBytes = size_t{1} << 20;

template <class Number>
void put_number(std::string& text, Number value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void put_vector(std::string& text, Vec3 values) {
  for (int k = 0; k < 3; ++k) {
    text += ' ';
    put_number(text, values[k]);
  }
}

// Four digits tell the 255 levels of a display.
void put_color(std::string& text, Rgb shown) {
  for (int k = 0; k < 3; ++k) {
    char digits[32];
    const float value = encode_srgb(shown[k]);
    text += ' ';
    text.append(digits,
                std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, 4).ptr);
  }
}

}  // namespace

void export_obj(NewFile& file, const FinishedRun& run) {
  const Scene& scene = run.scene;
  const LitMesh mesh = make_lit_mesh(scene, run.solution, scene.output.shading);
  const TriangleTable triangles = make_triangles(mesh);
  const std::vector<Rgb> shown = expose_values(mesh.radiosity, *run.report.exposure_ev);
  std::string text = fmt::format("# patchlight {}; lengths in {}; exposure EV {:.2f}\n", version_number(),
                                 scene.units, *run.report.exposure_ev);
  const auto flush_if = [&](bool due) {
    if (!due) return;
    append_file(file, text);
    text.clear();
  };
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    text += 'v';
    put_vector(text, Vec3(to_file_units(scene, mesh.position[v])));
    put_color(text, shown[v]);
    text += '\n';
    flush_if(text.size() >= kChunkBytes);
  }
  for (const Vec3& normal : find_polygon_normals(scene)) {
    text += "vn";
    put_vector(text, normal);
    text += '\n';
  }
  const ThingTable things = find_things(scene.polygons);
  for (size_t t = 0; t < things.size(); ++t) {
    text += "o " + things.name[t] + "\n";
    for (uint32_t p = things.first[t]; p < things.first[t + 1]; ++p) {
      const uint32_t polygon = things.polygon[p];
      text += "g " + scene.polygons.id[polygon] + "\n";
      for (uint32_t k = triangles.polygon_first[polygon]; k < triangles.polygon_first[polygon + 1]; ++k) {
        text += 'f';
        for (const uint32_t corner : triangles.corner[k]) {
          // Rows of OBJ count from 1.
          text += ' ';
          put_number(text, corner + 1);
          text += "//";
          put_number(text, polygon + 1);
        }
        text += '\n';
        flush_if(text.size() >= kChunkBytes);
      }
    }
  }
  flush_if(true);
}

}  // namespace patchlight
