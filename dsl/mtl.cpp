// Wavefront MTL: the diffuse reflectances of an OBJ file's materials.
#include "mtl.h"

#include "limits.h"
#include "statements.h"

#include <algorithm>

namespace patchlight {
namespace {

// One number for all channels, or three. False after an error.
bool read_colour(Messages& messages, StatementReader& reader, DRgb& colour) {
  const std::string_view rest = rest_of(reader);
  if (rest.starts_with("spectral") || rest.starts_with("xyz")) {
    add_error(messages, place_of(reader, rest), "mesh-invalid",
              "colours are read as r g b, not as 'spectral' or 'xyz'");
    return false;
  }
  if (!next_number(messages, reader, colour.r)) return false;
  colour.g = colour.b = colour.r;
  if (const std::string_view more = rest_of(reader); more.empty() || more[0] == '#') return true;
  return next_number(messages, reader, colour.g) && next_number(messages, reader, colour.b);
}

}  // namespace

bool read_mtl(Messages& messages, uint32_t file, MtlTable& table) {
  StatementReader reader = read_statements(messages, file);
  const size_t errors_before = messages.error_count, first = table.size();
  std::string_view keyword;
  bool has_d = false;  // of this material: d says more than Tr, which some programs write the wrong way round
  while (messages.error_count - errors_before < kErrorsShown && next_statement(reader, keyword)) {
    if (keyword == "newmtl") {
      table.name.emplace_back(rest_of(reader));
      table.place.push_back(place_of(reader, keyword));
      table.reflectance.emplace_back(0);
      table.has_kd.push_back(0);
      table.emits.push_back(0);
      table.textured.push_back(0);
      table.transparent.push_back(0);
      table.row_of.emplace(table.name.back(), static_cast<uint32_t>(table.size() - 1));
      has_d = false;
      continue;
    }
    if (table.size() == first) continue;  // belongs to no material
    DRgb colour(0);
    if (keyword == "Kd" && read_colour(messages, reader, colour)) {
      table.reflectance.back() = colour;
      table.has_kd.back() = 1;
    } else if (keyword == "Ke" && read_colour(messages, reader, colour)) {
      table.emits.back() = std::max({colour.r, colour.g, colour.b}) > 0;
    } else if (keyword == "map_Kd") {
      table.textured.back() = 1;
    } else if (keyword == "d" || keyword == "Tr") {
      if (rest_of(reader).starts_with("-halo")) next_word(reader);
      double value = 0;
      if (!next_number(messages, reader, value)) continue;
      if (keyword == "Tr" && has_d) continue;
      has_d = keyword == "d";
      table.transparent.back() = has_d ? value < 1 : value > 0;
    }
  }
  return messages.error_count == errors_before;
}

}  // namespace patchlight
