// Elements -> S-patches.csv, a row each, with the shortest decimals that read back as the same float.
#include "engine/mesh/cell.h"
#include "tools/base/format.h"
#include "tools/export/exporters.h"

#include <charconv>

namespace patchlight {
namespace {

constexpr size_t kChunkBytes = size_t{1} << 20;
constexpr const char* kHeader =
    "polygon,level,x,y,z,nx,ny,nz,area,reflectance_r,reflectance_g,reflectance_b,"
    "emission_r,emission_g,emission_b,radiosity_r,radiosity_g,radiosity_b\n";

void put(std::string& line, float value) {
  char digits[32];
  const auto result = std::to_chars(digits, digits + sizeof digits, value);
  line += ',';
  line.append(digits, result.ptr);
}

template <class Vector>
void put_three(std::string& line, const Vector& values) {
  for (int k = 0; k < 3; ++k) put(line, static_cast<float>(values[k]));
}

}  // namespace

void export_csv(NewFile& file, const FinishedRun& run) {
  const Scene& scene = run.scene;
  const Solution& solution = run.solution;
  const PatchTable& elements = solution.mesh.elements;
  const FaceTable& faces = scene.faces;
  const double area_scale = scene.units_per_length * scene.units_per_length;
  std::string text = kHeader;
  for (size_t row = 0; row < elements.size(); ++row) {
    const uint32_t face = elements.face[row];
    const DVec3 centre(cell_centre(solution.surfaces->frames, face, elements.cell[row], elements.level[row]));
    text += quote_csv(scene.polygons.id[faces.polygon[face]]);
    text += ',';
    text += std::to_string(elements.level[row]);
    put_three(text, scene.origin + centre * scene.units_per_length);
    put_three(text, faces.normal[face]);
    put(text, static_cast<float>(elements.area[row] * area_scale));
    put_three(text, faces.reflectance[face]);
    put_three(text, faces.emission[face]);
    put_three(text, elements.radiosity[row]);
    text += '\n';
    if (text.size() >= kChunkBytes) {
      append_file(file, text);
      text.clear();
    }
  }
  append_file(file, text);
}

}  // namespace patchlight
