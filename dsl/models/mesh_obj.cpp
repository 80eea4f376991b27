// Wavefront OBJ, strictly: text to tables (Wavefront: Advanced Visualizer, appendix B1, Object Files).
#include "dsl/models/mesh_formats.h"
#include "dsl/models/statements.h"
#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace patchlight {
namespace {

// Statements that say nothing about polygons. Others are refused: they would mean a lost part or no OBJ.
constexpr std::array<std::string_view, 16> kPassedOver = {
    "vt",       "vn",       "g",   "o",      "s",      "l",  "p",          "bevel",
    "c_interp", "d_interp", "lod", "maplib", "usemap", "mg", "shadow_obj", "trace_obj"};
constexpr std::array<std::string_view, 7> kCurved = {"cstype", "curv", "curv2", "surf", "vp", "bzp", "bsp"};

struct Reader {
  Messages& messages;
  StatementReader statements;
  MeshTable& mesh;
  std::pair<const std::string, uint32_t>* material = nullptr;  // that usemtl chose last: its name and row
  uint32_t material_line = 0;
  bool reaches_ahead = false;  // some index names a vertex that had not come yet
};

void report(Reader& reader, std::string_view word, std::string_view slug, std::string message) {
  add_error(reader.messages, place_of(reader.statements, word), slug, std::move(message));
}

void read_vertex(Reader& reader) {
  // What follows the third number is a weight or a colour.
  DVec3 p(0);
  bool good = true;
  for (int k = 0; k < 3 && good; ++k) good = next_number(reader.messages, reader.statements, p[k]);
  if (good && !(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kCoordinateMax))
    report(reader, {}, "coordinate-too-large",
           fmt::format("[{:g}, {:g}, {:g}] is beyond the limit of {:g}", p.x, p.y, p.z, kCoordinateMax));
  reader.mesh.position.push_back(p);
}

// The first whole number of a text, which it is moved behind; false where there is none.
bool take_integer(std::string_view& text, int64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return true;
}

// A corner: v, v/vt, v//vn or v/vt/vn. Only v counts; the others are to be whole numbers.
bool take_corner(std::string_view word, int64_t& index) {
  std::string_view text = word;
  if (!take_integer(text, index)) return false;
  int64_t unused = 0;
  for (int k = 0; k < 2 && text.starts_with('/'); ++k) {
    text.remove_prefix(1);
    if (!text.empty() && text[0] != '/' && !take_integer(text, unused)) return false;
  }
  return text.empty();
}

// The row of the material that faces have here, made for the first of them; kNone for no material.
uint32_t row_of_material(Reader& reader) {
  if (!reader.material) return kNone;
  auto& [name, row] = *reader.material;
  if (row == kNone) {
    row = static_cast<uint32_t>(reader.mesh.material.size());
    reader.mesh.material.push_back(name);
    reader.mesh.material_line.push_back(reader.material_line);
  }
  return row;
}

void read_face(Reader& reader) {
  MeshTable& mesh = reader.mesh;
  const auto vertices = static_cast<int64_t>(mesh.position.size());
  const size_t first = mesh.corner.size();
  bool good = true;
  const auto refuse = [&](std::string_view word, std::string message) {
    report(reader, word, "mesh-invalid", std::move(message));
    good = false;
  };
  for (std::string_view word = next_word(reader.statements); !word.empty();
       word = next_word(reader.statements)) {
    if (word[0] == '#') break;
    int64_t index = 0;
    if (!take_corner(word, index))
      refuse(word, fmt::format("expected a corner like 3, 3/1, 3//2 or 3/1/2, got '{}'", escape_text(word)));
    else if (index == 0)
      refuse(word, "vertices are counted from 1, there is none with number 0");
    else if (index < -vertices || index >= static_cast<int64_t>(kNone))
      refuse(word, fmt::format("there is no vertex {}: {} came before this line", index, vertices));
    if (!good) break;
    if (index > vertices) reader.reaches_ahead = true;
    mesh.corner.push_back(static_cast<uint32_t>(index > 0 ? index - 1 : vertices + index));
  }
  const size_t count = mesh.corner.size() - first;
  if (good && count == 0) refuse({}, "a face without corners");
  const Limits& limits = reader.messages.limits;
  if (count > limits.corners)
    report(reader, {}, "too-many-polygons",
           fmt::format("a face has {} corners, more than the limit of {}", count,
                       limit_text(limits, &Limits::corners)));
  mesh.face_first.push_back(static_cast<uint32_t>(mesh.corner.size()));
  mesh.face_line.push_back(reader.statements.line);
  mesh.face_material.push_back(row_of_material(reader));
}

void read_material(Reader& reader) {
  const std::string name(rest_of(reader.statements));
  reader.material = name.empty() ? nullptr : &*reader.mesh.material_row.emplace(name, kNone).first;
  reader.material_line = reader.statements.line;
}

bool is_face(std::string_view keyword) { return keyword == "f" || keyword == "fo"; }

void read_statement(Reader& reader, std::string_view keyword) {
  if (keyword == "v") return read_vertex(reader);
  if (is_face(keyword)) return read_face(reader);
  if (keyword == "usemtl") return read_material(reader);
  if (keyword == "mtllib") {
    reader.mesh.library.emplace_back(rest_of(reader.statements));
    reader.mesh.library_line.push_back(reader.statements.line);
    return;
  }
  const auto is_in = [&](const auto& list) {
    return std::find(list.begin(), list.end(), keyword) != list.end();
  };
  if (is_in(kPassedOver)) return;
  report(reader, keyword, "mesh-invalid",
         is_in(kCurved)
             ? fmt::format("'{}': curved surfaces are not read; export the model as polygons", keyword)
             : fmt::format("'{}' is no statement of an OBJ file", escape_text(keyword)));
}

// Indices of vertices that came later than the face, or never.
void check_ahead(Reader& reader) {
  const MeshTable& mesh = reader.mesh;
  for (size_t f = 0; f < mesh.face_count(); ++f)
    for (uint32_t k = mesh.face_first[f]; k < mesh.face_first[f + 1]; ++k) {
      if (mesh.corner[k] < mesh.position.size()) continue;
      add_error(reader.messages, {reader.statements.file, mesh.face_line[f], 1}, "mesh-invalid",
                fmt::format("there is no vertex {}: the file has {}", mesh.corner[k] + uint64_t{1},
                            mesh.position.size()));
      break;
    }
}

}  // namespace

// Reads v, f, usemtl and mtllib. Indices are checked; texture coordinates, normals, groups, smoothing, lines
// and points are passed over. False after errors: mesh-invalid, non-finite, number-out-of-range,
// coordinate-too-large, too-many-polygons.
bool read_obj(Messages& messages, uint32_t file, MeshTable& mesh) {
  Reader reader{messages, read_statements(messages, file), mesh};
  const size_t errors_before = messages.error_count;
  const auto errors = [&] { return messages.error_count - errors_before; };
  std::string_view keyword;
  // A file that is no OBJ at all would have an error in every line.
  const uint64_t polygons = messages.limits.polygons;
  while (errors() < kErrorsShown && next_statement(reader.statements, keyword)) {
    if (mesh.position.size() > kCornersPerPolygon * polygons ||
        (mesh.face_count() >= polygons && is_face(keyword))) {
      report(reader, keyword, "too-many-polygons",
             fmt::format("more than the limit of {}", limit_text(messages.limits, &Limits::polygons)));
      return false;
    }
    read_statement(reader, keyword);
  }
  if (errors() == 0 && reader.reaches_ahead) check_ahead(reader);
  if (errors() == 0 && mesh.face_count() == 0)
    add_error(
        messages, {file, 1, 1}, "mesh-invalid",
        fmt::format("no faces: the file has {} vertices and nothing that joins them", mesh.position.size()));
  return errors() == 0;
}

}  // namespace patchlight
