// The formats of mesh files that are read.
#pragma once

#include "dsl/models/mesh_table.h"

#include <span>
#include <string_view>

namespace patchlight {

// What a format calls its things, for messages.
struct MeshWords {
  std::string_view file;         // that has the faces
  std::string_view materials;    // a file that defines its materials
  std::string_view reflectance;  // diffuse
  std::string_view emission;
};

struct MeshFormat {
  std::string_view suffix;  // of the file's name, lower case, with its point
  // The text or bytes of messages.files[file] to an empty table; false after errors.
  bool (*read)(Messages& messages, uint32_t file, MeshTable& mesh);
  // Fills mesh.defined from other files, once some of it is asked for; nullptr: `read` does.
  bool (*read_materials)(Messages& messages, uint32_t file, MeshTable& mesh);
  MeshWords words;
};

std::span<const MeshFormat> mesh_formats();

// The format that a name's suffix tells, in upper or lower case; the first one where there is no such suffix.
const MeshFormat& format_of_mesh(std::string_view name);

}  // namespace patchlight
