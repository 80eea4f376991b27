// The page's data, read back as tools/page/README.md describes it. What the page does with it is seen in a
// browser: tests/page/check.mjs.
#include "tests/folder.h"
#include "tests/tools/export/lit_scene.h"
#include "tools/base/json.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"
#include "tools/export/page_html.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <bit>
#include <cstring>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

std::string find_element(const std::string& page, const std::string& id) {
  const std::string open = " id=\"" + id + "\">";
  const size_t at = page.find(open);
  REQUIRE_MESSAGE(at != std::string::npos, id);
  CHECK(page.find(open, at + 1) == std::string::npos);
  const size_t first = at + open.size();
  return page.substr(first, page.find("</script>", first) - first);
}

std::string decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t bits = 0, bit_count = 0;
  CHECK(text.size() % 4 == 0);
  for (const char c : text) {
    if (c == '=') break;
    REQUIRE(digits.find(c) != std::string::npos);
    bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
    if ((bit_count += 6) >= 8) bytes += static_cast<char>(bits >> (bit_count -= 8) & 255);
  }
  return bytes;
}

struct PageData {
  Json header;
  std::string page;
};

PageData make_page(const LitScene& lit) {
  const Folder folder;
  NewFile file;
  open_file(file, folder / "s.html");
  find_exporter("html").export_run(file, lit.finished());
  commit_file(file);
  PageData data;
  data.page = read_bytes(folder / "s.html");
  data.header = Json::parse(find_element(data.page, "patchlight"));
  return data;
}

const Json& find_block(const PageData& data, const std::string& name) {
  for (const Json& block : data.header["blocks"])
    if (block["name"] == name) return block;
  FAIL("no block " << name);
  return data.header;
}

std::string read_block(const PageData& data, const std::string& name) {
  const Json& block = find_block(data, name);
  const std::string packed = decode_base64(find_element(data.page, name));
  const size_t bytes_a_row = block["type"] == "uint8" || block["type"] == "json" ? 1 : 4;
  std::string bytes(block["count"].get<size_t>() * bytes_a_row + 1, '\0');
  uLongf size = bytes.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                     reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  REQUIRE(size == bytes.size() - 1);
  bytes.resize(size);
  return bytes;
}

std::vector<uint32_t> join_planes(const std::string& bytes) {
  const size_t count = bytes.size() / 4;
  std::vector<uint32_t> words(count, 0);
  for (size_t k = 0; k < 4 * count; ++k)
    words[k % count] |= static_cast<uint32_t>(static_cast<uint8_t>(bytes[k])) << 8 * (k / count);
  return words;
}

std::vector<uint32_t> read_words(const PageData& data, const std::string& name) {
  std::vector<uint32_t> words = join_planes(read_block(data, name));
  const size_t delta = find_block(data, name)["delta"];
  for (size_t k = delta; k < words.size(); ++k) words[k] += words[k - delta];
  return words;
}

// Floats in rows of `width` against those of a column.
template <class Value>
void check_floats(const PageData& data, const std::string& name, const std::vector<Value>& column) {
  const std::vector<uint32_t> words = read_words(data, name);
  REQUIRE(words.size() * 4 == column.size() * sizeof(Value));
  CHECK_MESSAGE(std::memcmp(words.data(), column.data(), words.size() * 4) == 0, name);
}

std::vector<uint32_t> read_light(const PageData& data, const std::string& name) {
  std::vector<uint32_t> words = join_planes(read_block(data, name));
  const Json& block = find_block(data, name);
  std::vector<uint32_t> base(words.size(), 0);
  const bool has_base = block.contains("base");
  if (has_base) base = read_light(data, block["base"]);
  for (size_t k = 0; k < words.size(); ++k) {
    const uint32_t from = has_base ? base[k] : k > 0 ? words[k - 1] : 0;
    // Each of the four fields by itself.
    const uint32_t word = words[k];
    words[k] = 0;
    for (const uint32_t field : {0x1ffu, 0x3fe00u, 0x7fc0000u, 0xf8000000u})
      words[k] |= ((word & field) + (from & field)) & field;
  }
  return words;
}

}  // namespace

TEST_CASE("a page holds the mesh, the numbers of the patches and the light after each recorded pass") {
  const LitScene lit = make_lit_scene();
  const PageData data = make_page(lit);
  CHECK(data.header["format"] == "patchlight-page");
  CHECK(data.header["version"] == 1);
  CHECK(data.header["step"] == "pass");
  CHECK(data.header["passes"] == Json{1, 2, 3});
  CHECK(data.header["units"] == "cm");
  CHECK(data.header["exposure"] == -1);
  CHECK(data.header["shading"] == "smooth");

  const LitMesh mesh = make_lit_mesh(lit.scene, lit.solution, Shading::kSmooth);
  const PatchTable& elements = lit.solution.mesh.elements;
  check_floats(data, "position", mesh.position);
  CHECK(read_words(data, "outline") == mesh.outline);
  CHECK(read_words(data, "polygon-patch") == mesh.element_first);
  check_floats(data, "area", elements.area);
  check_floats(data, "exposed", elements.exposed);
  check_floats(data, "radiosity", elements.radiosity);
  check_floats(data, "irradiance", element_irradiance(lit.solution));
  const std::string counts = read_block(data, "outline-count"), levels = read_block(data, "level");
  REQUIRE(counts.size() == elements.size());
  REQUIRE(levels.size() == elements.size());
  for (size_t row = 0; row < elements.size(); ++row) {
    CHECK(static_cast<uint8_t>(counts[row]) == mesh.outline_first[row + 1] - mesh.outline_first[row]);
    CHECK(static_cast<uint8_t>(levels[row]) == elements.level[row]);
  }
  const Json polygons = Json::parse(read_block(data, "polygons"));
  CHECK(polygons["id"] == Json(lit.scene.polygons.id));
  CHECK(polygons["emission"][6] == Json{9, 8, 7});
  CHECK(polygons["reflectance"][7][0].get<float>() == 0.7f);

  for (size_t k = 0; k < lit.record.size(); ++k) {
    const std::string pass = std::to_string(lit.record.pass[k]);
    CHECK(read_light(data, "patch-" + pass) == lit.record.element[k]);
    const std::vector<uint32_t> vertices = read_light(data, "vertex-" + pass);
    REQUIRE(vertices.size() == mesh.vertex_count());
    for (size_t v = 0; v < vertices.size(); ++v) CHECK(vertices[v] == lit.record.vertex[k][mesh.source[v]]);
  }
}

TEST_CASE("texts of a scene cannot end the element that they stand in") {
  LitScene lit = make_lit_scene();
  lit.scene.title = "</script><script>alert(1)</script><!-- \xff";
  lit.scene.file = "</SCRIPT>.yaml";
  const PageData data = make_page(lit);
  const std::string header = find_element(data.page, "patchlight");
  CHECK(header.find('<') == std::string::npos);
  CHECK(data.header["title"] == "</script><script>alert(1)</script><!-- \xef\xbf\xbd");
}

TEST_CASE("the page in the program is tools/page/page.html, with one place for data") {
  const std::string page(page_html());
  CHECK((page == read_bytes(PATCHLIGHT_SOURCE_DIR "/tools/page/page.html")));
  const std::string mark = "<!-- data -->";
  CHECK(page.find(mark) != std::string::npos);
  CHECK(page.find(mark) == page.rfind(mark));
}
