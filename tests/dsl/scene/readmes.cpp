// The scenes that are shipped, and those that stand in the READMEs: they load, and the tour and the reference
// have them all.
#include "dsl/scene/load.h"
#include "dsl/shapes/shapes.h"
#include "tests/folder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

namespace patchlight::test {
namespace {

using testing::read_bytes;

const std::string kRoot = PATCHLIGHT_SOURCE_DIR;

struct Block {
  std::string text;    // a whole scene
  std::string before;  // what stands above it, from the end of the scene before
};

// The scenes of a README: blocks of yaml that begin with the language's version.
std::vector<Block> list_blocks(const std::string& path) {
  const std::string text = read_bytes(path), fence = "```yaml\n", end_fence = "\n```\n";
  std::vector<Block> blocks;
  size_t end = 0, whole_end = 0;
  for (size_t begin; (begin = text.find("\n" + fence, end)) != std::string::npos;) {
    const size_t first = begin + 1 + fence.size(), last = text.find(end_fence, first);
    REQUIRE(last != std::string::npos);
    const std::string block = text.substr(first, last + 1 - first);
    end = last + end_fence.size();
    if (!block.starts_with("patchlight: 1\n")) continue;
    blocks.push_back({block, text.substr(whole_end, begin - whole_end)});
    whole_end = end;
  }
  return blocks;
}

std::string join_messages(const std::vector<Diagnostic>& messages) {
  std::string text;
  for (const Diagnostic& message : messages) text += format_diagnostic(message) + "\n";
  return text;
}

// Loads a text as a file of that path, which must be possible without any message.
void check_loads(const std::string& text, const std::string& path) {
  CAPTURE(text);
  std::vector<Diagnostic> messages;
  try {
    CHECK(load_scene_text(text, path, messages).faces.size() > 0);
  } catch (const UserError& error) {
    messages = error.diagnostics;
  }
  CHECK(join_messages(messages) == "");
}

// Names in a folder that end so, without the end.
std::vector<std::string> list_stems(const std::string& folder, const std::string& extension) {
  std::vector<std::string> stems;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == extension) stems.push_back(entry.path().stem().string());
  return stems;
}

// The lines of a text, the first `count` of them at most.
std::vector<std::string> first_lines(const std::string& text, size_t count) {
  std::vector<std::string> lines;
  for (size_t at = 0; at < text.size() && lines.size() < count;) {
    const size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

TEST_CASE("every scene in a README loads without a message, as a file of scenes/") {
  size_t count = 0;
  for (const char* path : {"/README.md", "/dsl/README.md", "/scenes/README.md"})
    for (const Block& block : list_blocks(kRoot + path)) {
      check_loads(block.text, kRoot + "/scenes/block.yaml");
      ++count;
    }
  CHECK(count >= 14);
}

TEST_CASE("the reference shows every shape: a picture, and below it the scene that makes it") {
  const std::vector<Block> blocks = list_blocks(kRoot + "/dsl/README.md");
  for (const ShapeRow& shape : shape_rows()) {
    const std::string name(shape.name);
    CAPTURE(name);
    const auto block = std::find_if(blocks.begin(), blocks.end(), [&](const Block& candidate) {
      return candidate.before.find("\n### " + name + "\n") != std::string::npos;
    });
    REQUIRE(block != blocks.end());
    CHECK(block->before.ends_with("\n![](pictures/" + name + ".png)\n"));
    CHECK(block->text.find(name + ":") != std::string::npos);
  }
}

TEST_CASE("shipped scenes load without a message; of the Cornell box one is said, as its head tells") {
  for (const std::string& name : list_stems(kRoot + "/scenes", ".yaml")) {
    const std::string path = kRoot + "/scenes/" + name + ".yaml";
    CAPTURE(path);
    if (name != "cornell_box") {
      check_loads(read_bytes(path), path);
      continue;
    }
    std::vector<Diagnostic> warnings;
    load_scene(path, warnings);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].slug == "non-planar");
  }
}

TEST_CASE("shipped scenes say in three lines of comment what they are and what they teach") {
  for (const std::string& name : list_stems(kRoot + "/scenes", ".yaml")) {
    CAPTURE(name);
    const std::vector<std::string> lines = first_lines(read_bytes(kRoot + "/scenes/" + name + ".yaml"), 4);
    REQUIRE(lines.size() == 4);
    for (const std::string& line : lines) CHECK(line.starts_with("# "));
    CHECK(lines[3].starts_with("# Teaches: "));
  }
}

TEST_CASE("the tour names every shipped scene, with a command") {
  const std::string tour = read_bytes(kRoot + "/scenes/README.md");
  for (const std::string& name : list_stems(kRoot + "/scenes", ".yaml")) {
    CAPTURE(name);
    CHECK(tour.find("[" + name + "](" + name + ".yaml): ") != std::string::npos);
    CHECK(tour.find(" scenes/" + name + ".yaml") != std::string::npos);
  }
}

TEST_CASE("every picture that a README shows is there, and every picture is shown") {
  for (const char* folder : {"dsl", "engine", "scenes"}) {
    const std::string own = read_bytes(kRoot + "/" + folder + "/README.md"),
                      first = read_bytes(kRoot + "/README.md");
    const std::string mark = "](pictures/";
    for (size_t at = 0; (at = own.find(mark, at)) != std::string::npos; at += mark.size()) {
      const size_t begin = at + 2;
      const std::string path = kRoot + "/" + folder + "/" + own.substr(begin, own.find(')', begin) - begin);
      CHECK_MESSAGE(std::filesystem::exists(path), path);
    }
    for (const std::string& name : list_stems(kRoot + "/" + folder + "/pictures", ".png")) {
      const std::string picture = "pictures/" + name + ".png)";
      CHECK_MESSAGE((own.find("](" + picture) != std::string::npos ||
                     first.find("](" + std::string(folder) + "/" + picture) != std::string::npos),
                    folder, "/", picture);
    }
  }
}

}  // namespace
}  // namespace patchlight::test
