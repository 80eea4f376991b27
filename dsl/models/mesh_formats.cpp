// The formats of mesh files. A new one is its file, mesh_<name>.cpp, and its row here.
#include "dsl/models/mesh_formats.h"

#include <algorithm>

namespace patchlight {

bool read_obj(Messages& messages, uint32_t file, MeshTable& mesh);
bool read_mtl_files(Messages& messages, uint32_t file, MeshTable& mesh);

std::span<const MeshFormat> mesh_formats() {
  static constexpr MeshFormat kRows[] = {
      {".obj", read_obj, read_mtl_files, {"OBJ", "MTL", "Kd", "Ke"}},
  };
  return kRows;
}

const MeshFormat& format_of_mesh(std::string_view name) {
  const auto same = [](char a, char lower) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == lower; };
  for (const MeshFormat& row : mesh_formats())
    if (name.size() >= row.suffix.size() && std::equal(name.end() - static_cast<ptrdiff_t>(row.suffix.size()),
                                                       name.end(), row.suffix.begin(), same))
      return row;
  return mesh_formats()[0];
}

}  // namespace patchlight
