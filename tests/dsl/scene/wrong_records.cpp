// Wrong scenes of the records in wrong/, and those that no text file can hold well: what each is told, and
// where.
#include "tests/dsl/support.h"
#include "tests/folder.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace patchlight::test {
namespace {

// One record: a scene and what its first message is.
struct Record {
  std::string name, slug, place, said, scene;
  int exit = 3;
};

std::string take_line(std::string& text) {
  const size_t end = std::min(text.find('\n'), text.size());
  const std::string line = text.substr(0, end);
  text.erase(0, end + 1);
  return line;
}

std::string take_word(std::string& line) {
  const size_t end = std::min(line.find(' '), line.size());
  const std::string word = line.substr(0, end);
  line.erase(0, end + 1);
  return word;
}

Record parse_record(std::string text) {
  Record record;
  record.name = take_line(text);
  std::string answer = take_line(text);
  REQUIRE(take_word(answer) == "=>");
  record.slug = take_word(answer);
  if (answer.starts_with('(')) record.exit = std::stoi(take_word(answer).substr(1));
  record.place = take_word(answer);
  record.said = answer;
  for (const auto& [name, scene] : {std::pair<std::string_view, std::string>{"@base\n", kBase},
                                    {"@objects\n", kHead + kLight},
                                    {"@head\n", kHead}})
    if (text.starts_with(name)) text.replace(0, name.size(), scene);
  record.scene = text;
  return record;
}

std::vector<Record> read_records(const std::string& name) {
  const std::string text = testing::read_bytes(PATCHLIGHT_SOURCE_DIR "/tests/dsl/scene/wrong/" + name);
  std::vector<Record> records;
  for (size_t at = text.find("\n### "); at != std::string::npos;) {
    at += 5;
    const size_t end = text.find("\n### ", at);
    records.push_back(parse_record(text.substr(at, end == std::string::npos ? end : end + 1 - at)));
    at = end;
  }
  return records;
}

void check_record(const Record& record) {
  CAPTURE(record.name);
  const Loaded loaded = load(record.scene);
  REQUIRE(!loaded.errors.empty());
  const Diagnostic& first = loaded.errors.front();
  CAPTURE(first.message);
  CHECK(first.slug == record.slug);
  CHECK(fmt::format("{}:{}", first.line, first.column) == record.place);
  CHECK(first.message.starts_with(record.said));
  CHECK(first.file == "t.yaml");
  CHECK(exit_code(first) == record.exit);
}

TEST_CASE("wrong YAML is told at its place, with what to write instead") {
  const std::vector<Record> records = read_records("syntax.txt");
  CHECK(records.size() >= 55);
  for (const Record& record : records) check_record(record);
}

TEST_CASE("wrong keys, names and settings are told at their place, with what was expected") {
  const std::vector<Record> records = read_records("keys.txt");
  CHECK(records.size() >= 220);
  for (const Record& record : records) check_record(record);
}

TEST_CASE("wrong numbers, expressions and polygons are told at their place, with what was expected") {
  const std::vector<Record> records = read_records("values.txt");
  CHECK(records.size() >= 150);
  for (const Record& record : records) check_record(record);
}

TEST_CASE("the reference lists every slug of the records") {
  const std::string text = testing::read_bytes(PATCHLIGHT_SOURCE_DIR "/dsl/README.md");
  for (const char* name : {"syntax.txt", "keys.txt", "values.txt"})
    for (const Record& record : read_records(name)) {
      CAPTURE(record.slug);
      CHECK(text.find("`" + record.slug + "`") != std::string::npos);
    }
}

TEST_CASE("bytes that are no text, text that does not look like what it is, and what is very long are told") {
  const std::string polygon = kHead + kLight + "  - {quad: {size: [1, 1], center: [";
  const std::vector<Record> records = {
      {"tab", "yaml-tab-indent", "3:1", "a tab may not indent YAML; use spaces",
       "patchlight: 1\nmaterials:\n\twhite: {reflectance: 0.5}\n"},
      {"tab behind blanks", "yaml-tab-indent", "9:1", "a tab may not indent YAML",
       kBase + "solver:\n  \tpasses: 3\n"},
      {"tab behind a dash", "yaml-tab-indent", "6:3", "a tab may not stand between '-' and a key",
       kHead + "  -\tid: a\n    quad: {size: [1,1]}\n"},
      {"no-break space", "yaml-syntax", "9:1", "a no-break space (U+00A0) may not indent YAML",
       kBase + "solver:\n\xc2\xa0\xc2\xa0passes: 3\n"},
      {"carriage returns alone", "control-character", "1:14", "a carriage return without a line feed",
       "patchlight: 1\robjects: []\r"},
      {"escape character in a key", "unknown-key", "8:1",
       "unknown key '\\x1b[31mkey' in scene; known: patchlight, title", kBase + "\"\x1b[31mkey\": 1\n"},
      {"escape character in a title", "control-character", "8:8",
       "control character 0x1b in '\\x1b[31m'; take it out", kBase + "title: \"\x1b[31m\"\n"},
      {"bell", "control-character", "8:9", "control character 0x07",
       kBase + "title: a\x07"
               "b\n"},
      {"delete", "control-character", "8:8", "control character 0x7f in 'a\\x7fb'",
       kBase + "title: a\x7f"
               "b\n"},
      {"second set of control characters", "control-character", "8:8", "control character 0x9b in 'a\\x9bb'",
       kBase + "title: a\xc2\x9b"
               "b\n"},
      {"form feed", "control-character", "8:1", "control character 0x0c", kBase + "\x0ctitle: b\n"},
      {"overlong", "not-utf8", "8:8", "byte 0xc0 is not UTF-8; save the file as UTF-8",
       kBase + "title: \xc0\xaf\n"},
      {"Latin 1", "not-utf8", "8:11", "byte 0xe9 is not UTF-8; save the file as UTF-8",
       kBase + "title: caf\xe9\n"},
      {"surrogate", "not-utf8", "8:8", "byte 0xed is not UTF-8", kBase + "title: \xed\xa0\x80\n"},
      {"five bytes", "not-utf8", "8:8", "byte 0xf8 is not UTF-8", kBase + "title: \xf8\x88\x80\x80\x80\n"},
      {"cut off", "not-utf8", "8:8", "byte 0xe2 is not UTF-8", kBase + "title: \xe2\x82"},
      {"beyond Unicode", "not-utf8", "8:8", "byte 0xf4 is not UTF-8", kBase + "title: \xf4\x90\x80\x80\n"},
      {"UTF-16", "not-utf8", "1:1", "the file is UTF-16 or no text at all; save it as UTF-8",
       std::string("\xff\xfe"
                   "p\0a\0t\0",
                   8)},
      {"UTF-16 without mark", "not-utf8", "1:1", "the file is UTF-16 or no text at all; save it as UTF-8",
       std::string("p\0a\0t\0c\0", 8)},
      {"big-endian UTF-16", "not-utf8", "1:1", "the file is UTF-16", std::string("\xfe\xff\0p\0a", 6)},
      {"UTF-32", "not-utf8", "1:1", "the file is UTF-16 or no text at all",
       std::string("\xff\xfe\0\0p\0\0\0", 8)},
      {"program", "not-utf8", "1:1", "the file is UTF-16 or no text at all",
       std::string("\x7f"
                   "ELF\2\1\1\0\0\0\0\0\0\0\0\0\3\0>\0\1\0\0\0",
                   24)},
      {"gzip", "not-utf8", "1:1", "the file is UTF-16 or no text at all",
       std::string("\x1f\x8b\x08\0\0\0\0\0\0\3\x4b\x2c", 12)},
      {"picture", "not-utf8", "1:1", "byte 0x89 is not UTF-8",
       std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)},
      {"zero byte", "control-character", "8:9", "a zero byte; is this a text file?",
       kBase + std::string("title: a\0b\n", 11)},
      {"zero byte at the end", "control-character", "8:1", "a zero byte", kBase + std::string(1, '\0')},
      {"id beyond ASCII", "bad-id", "7:10", "'id' begins with a letter",
       kHead + kLight + "  - {id: w\xc3\xa4rme, quad: {size: [1,1]}, material: white}\n"},
      {"minus sign of typesetters", "expected-number", "7:36", "expected a number",
       polygon + "\xe2\x88\x92"
                 "1, 0, 0]}, material: white}\n"},
      {"wide digit", "expected-number", "7:36", "expected a number",
       polygon + "\xef\xbc\x91, 0, 0]}, material: white}\n"},
      {"wide colon", "unknown-key", "8:1", "unknown key 'solver", kBase + "solver\xef\xbc\x9a {passes: 3}\n"},
      {"name that would colour the terminal", "bad-name", "3:3", "a material's name",
       "patchlight: 1\nmaterials:\n  \"\\x1b[31m\": {}\nobjects:\n  - {quad: {size: [1, 1]}, material: "
       "nope}\n"},
      {"100 000 brackets", "too-deep", "8:68",
       "nested deeper than the limit of 64 levels (--max-nesting raises it)",
       kBase + "x: " + std::string(100'000, '[') + std::string(100'000, ']') + "\n"},
      {"480 brackets", "too-deep", "8:68",
       "nested deeper than the limit of 64 levels (--max-nesting raises it)",
       kBase + "x: " + std::string(480, '[') + std::string(480, ']') + "\n"},
      {"key of a million characters", "unknown-key", "8:1",
       "unknown key '" + std::string(60, 'x') + "...': no key is that long",
       kBase + std::string(1'000'000, 'x') + ": 1\n"},
      {"400 digits", "number-out-of-range", "7:24", "'1000",
       kHead + kLight + "  - {id: p, polygon: [[1" + std::string(400, '0') +
           ",0,0],[1,0,0],[1,0,1]], material: white}\n"},
      {"expression of 1001 characters", "expression-too-long", "7:24",
       "1001 characters, more than the limit of 1000 characters (--max-expression raises it)",
       kHead + kLight + "  - {quad: {size: [1, '=" + std::string(1000, '1') + "']}, material: white}\n"},
      {"groups 200 deep", "too-deep", "7:293",
       "nested deeper than the limit of 64 levels (--max-nesting raises it)",
       kHead + kLight + "  - " + repeat_text("{group: [", 200) + "{quad: {size: [1,1]}, material: white}" +
           repeat_text("]}", 200) + "\n"},
  };
  for (const Record& record : records) check_record(record);
}

TEST_CASE("no message prints a byte of the file that could do something to a terminal") {
  const std::string evil = "\x1b[2J\xe2\x80\xae\x07";
  const std::vector<std::string> scenes = {
      kBase + "\"" + evil + "\": 1\n",
      kHead + kLight + "  - {quad: {size: [1, 1]}, material: \"" + evil + "\"}\n",
      kHead + kLight + "  - {id: \"" + evil + "\", quad: {size: [1, 1]}, material: white}\n",
      kBase + "units: \"" + evil + "\"\n",
      kBase + "include: [\"" + evil + "\"]\n",
      kBase + "let: {\"" + evil + "\": 1}\n",
      kBase + "expect: [{object: \"" + evil + "\", radiosity: 1}]\n",
      kBase + "solver: {passes: \"" + evil + "\"}\n",
      kBase + "solver: {passes: \"=" + evil + "\"}\n",
      kBase + "output: {basename: \"" + evil + "\"}\n",
      "patchlight: 1\nmaterials: {\"" + evil +
          "\": {emission: 1}}\nobjects: [{quad: {size: [1, 1]}, material: b}]\n",
      "patchlight: 1\nlet: {\"" + evil + "\": 1}\nobjects: [{quad: {size: [1, $x]}, material: b}]\n",
  };
  for (const std::string& scene : scenes) {
    const Loaded loaded = load(scene);
    REQUIRE(!loaded.errors.empty());
    for (const Diagnostic& error : loaded.errors) {
      const std::string text = format_diagnostic(error);
      CAPTURE(error.slug);
      CHECK(text.find_first_of("\x1b\x07") == std::string::npos);
      CHECK(text.find("\xe2\x80\xae") == std::string::npos);
    }
  }
}

TEST_CASE("aliases that stand for a billion objects are refused before they are followed") {
  std::string text = kHead + "  - &a0 {group: [{quad: {size: [1,1]}, material: white}]}\n";
  for (int k = 1; k < 10; ++k) {
    text += fmt::format("  - &a{} {{group: [", k);
    for (int i = 0; i < 10; ++i) text += fmt::format("{}*a{}", i > 0 ? "," : "", k - 1);
    text += "]}\n";
  }
  const Loaded loaded = load(text);
  REQUIRE(!loaded.errors.empty());
  CHECK(loaded.errors[0].slug == "alias-expansion");
}

}  // namespace
}  // namespace patchlight::test
