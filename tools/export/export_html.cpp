// The lit mesh and the recorded passes -> S.html: tools/page/page.html with the scene's data put in.
//
// page.html holds the viewer and is built ahead (tools/page/README.md, which also describes the data). Here
// columns become blocks of bytes that pack well, then zlib, then base64 between tags.
#include "dsl/report/diagnostics.h"
#include "engine/base/parallel.h"
#include "tools/base/bytes.h"
#include "tools/base/json.h"
#include "tools/base/version.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"
#include "tools/export/page_html.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cassert>
#include <new>

namespace patchlight {
namespace {

constexpr int kPageVersion = 1;
constexpr int kZlibLevel = 6;  // 9 takes five times as long for 1 % less
constexpr std::string_view kDataMark = "<!-- data -->";

// A column on its way into the page.
struct Block {
  Json about;                   // as the page's list of blocks tells it
  std::vector<uint32_t> words;  // the column as words of 32 bits ...
  std::string bytes;            // ... or as bytes; then packed
};

Block make_byte_block(std::string_view name, std::string_view type, std::string bytes) {
  return {{{"name", name}, {"type", type}, {"count", bytes.size()}}, {}, std::move(bytes)};
}

// Each word less the one `delta` rows before it: what is even or repeats becomes small numbers.
template <class Value>
Block make_word_block(std::string_view name, std::string_view type, std::span<const Value> values,
                      size_t delta) {
  static_assert(sizeof(Value) % sizeof(uint32_t) == 0);
  std::vector<uint32_t> words(values.size_bytes() / sizeof(uint32_t));
  std::memcpy(words.data(), values.data(), values.size_bytes());
  for (size_t k = words.size(); k-- > delta;) words[k] -= words[k - delta];
  return {{{"name", name}, {"type", type}, {"count", words.size()}, {"delta", delta}}, std::move(words), {}};
}

// The four fields of shared-exponent words less those of others, each by itself.
uint32_t subtract_fields(uint32_t word, uint32_t base) {
  uint32_t difference = 0;
  for (const auto& [shift, mask] : {std::pair{0, 511u}, {9, 511u}, {18, 511u}, {27, 31u}})
    difference |= (((word >> shift) - (base >> shift)) & mask) << shift;
  return difference;
}

// Light after a pass, less that of the recorded pass before, or of the row before where there is none: late
// passes add little.
Block make_light_block(std::string_view column, const PassRecord& record, size_t k,
                       std::span<const std::vector<uint32_t>> light, std::span<const uint32_t> rows) {
  const auto name = [&](size_t at) { return fmt::format("{}-{}", column, record.pass[at]); };
  Block block{{{"name", name(k)}, {"type", "rgb9e5"}, {"count", rows.size()}}, {}, {}};
  if (k > 0) block.about["base"] = name(k - 1);
  uint32_t last = 0;
  for (const uint32_t row : rows) {
    block.words.push_back(subtract_fields(light[k][row], k > 0 ? light[k - 1][row] : last));
    last = light[k][row];
  }
  return block;
}

// All first bytes of the words, then all second ones ...: bytes that mean the same stand together.
std::string split_planes(std::span<const uint32_t> words) {
  std::string planes;
  planes.reserve(4 * words.size());
  for (int shift = 0; shift < 32; shift += 8)
    for (const uint32_t word : words) planes += static_cast<char>(word >> shift & 255);
  return planes;
}

std::string compress_bytes(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), kZlibLevel);
  if (result != Z_OK) throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

// RFC 4648.
std::string encode_base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t k = 0; k < bytes.size(); k += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - k);
    uint32_t group = 0;
    for (size_t i = 0; i < 3; ++i) group = group << 8 | (i < count ? static_cast<uint8_t>(bytes[k + i]) : 0u);
    for (size_t i = 0; i < 4; ++i) text += i <= count ? kDigits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

template <class Vector>
Json make_array(const Vector& v) {
  return {v.x, v.y, v.z};
}

Block make_polygon_block(const Scene& scene) {
  Json polygons = {{"id", scene.polygons.id}, {"emission", Json::array()}, {"reflectance", Json::array()}};
  for (size_t polygon = 0; polygon < scene.polygons.size(); ++polygon) {
    const uint32_t face = scene.polygons.face_first[polygon];
    polygons["emission"].push_back(make_array(scene.faces.emission[face]));
    polygons["reflectance"].push_back(make_array(scene.faces.reflectance[face]));
  }
  return make_byte_block("polygons", "json", polygons.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::vector<Block> make_blocks(const Scene& scene, const Solution& solution, const PassRecord& record) {
  const PatchTable& elements = solution.mesh.elements;
  const LitMesh mesh = make_lit_mesh(scene, solution, Shading::kSmooth);
  std::string levels(elements.level.begin(), elements.level.end()), counts;
  for (size_t row = 0; row < elements.size(); ++row)
    counts += static_cast<char>(mesh.outline_first[row + 1] - mesh.outline_first[row]);
  const std::vector<Rgb> irradiance = element_irradiance(solution);
  std::vector<Block> blocks;
  blocks.push_back(make_polygon_block(scene));
  blocks.push_back(make_word_block<Vec3>("position", "float32", mesh.position, 3));
  blocks.push_back(make_byte_block("outline-count", "uint8", counts));
  blocks.push_back(make_word_block<uint32_t>("outline", "uint32", mesh.outline, 1));
  blocks.push_back(make_word_block<uint32_t>("polygon-patch", "uint32", mesh.element_first, 1));
  blocks.push_back(make_byte_block("level", "uint8", levels));
  blocks.push_back(make_word_block<float>("area", "float32", elements.area, 1));
  blocks.push_back(make_word_block<float>("exposed", "float32", elements.exposed, 1));
  blocks.push_back(make_word_block<Rgb>("radiosity", "float32", elements.radiosity, 3));
  blocks.push_back(make_word_block<Rgb>("irradiance", "float32", irradiance, 3));
  const std::vector<uint32_t> patches = all_rows(elements.size());
  for (size_t k = 0; k < record.size(); ++k) {
    blocks.push_back(make_light_block("vertex", record, k, record.vertex, mesh.source));
    blocks.push_back(make_light_block("patch", record, k, record.element, patches));
  }
  for_rows(blocks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      Block& block = blocks[k];
      if (block.bytes.empty()) block.bytes = split_planes(block.words);
      block.words = {};
      block.bytes = encode_base64(compress_bytes(block.bytes));
    }
  });
  return blocks;
}

Json make_header(const FinishedRun& run, std::span<const Block> blocks) {
  const Scene& scene = run.scene;
  Json header = {{"format", "patchlight-page"},
                 {"version", kPageVersion},
                 {"generator", fmt::format("patchlight {}", version_number())},
                 {"title", scene.title},
                 {"scene", scene.file},
                 {"units", scene.units},
                 {"metres_per_unit", scene.metres_per_unit},
                 {"origin", make_array(scene.origin)},
                 {"units_per_length", scene.units_per_length},
                 {"exposure", *run.report.exposure_ev},
                 {"shading", scene.output.shading == Shading::kFlat ? "flat" : "smooth"},
                 {"step", run.record.solver->step},
                 {"passes", run.record.pass}};
  for (const Camera& camera : scene.cameras)
    header["cameras"].push_back({{"name", camera.name},
                                 {"eye", make_array(camera.eye)},
                                 {"target", make_array(camera.target)},
                                 {"up", make_array(camera.up)},
                                 {"fov", camera.fov_degrees},
                                 {"aspect", double{1} * camera.width / camera.height}});
  for (const Block& block : blocks) header["blocks"].push_back(block.about);
  return header;
}

// JSON that cannot end the element that it stands in: no text of a scene may do that.
std::string escape_for_element(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

}  // namespace

void export_html(NewFile& file, const FinishedRun& run) {
  const std::string_view page = page_html();
  const size_t mark = page.find(kDataMark);
  assert(mark != std::string_view::npos);
  std::vector<Block> blocks = make_blocks(run.scene, run.solution, run.record);
  append_file(file, page.substr(0, mark));
  append_file(file, fmt::format("<script type=\"application/json\" id=\"patchlight\">{}</script>\n",
                                escape_for_element(make_header(run, blocks))));
  for (Block& block : blocks) {
    append_file(file, fmt::format("<script type=\"application/octet-stream\" id=\"{}\">",
                                  block.about["name"].get<std::string>()));
    append_file(file, block.bytes);
    append_file(file, "</script>\n");
    block.bytes = {};
  }
  append_file(file, page.substr(mark + kDataMark.size()));
}

}  // namespace patchlight
