// The list `include`. Files are read only below the scene's own folder, and never from a network.
#include "dsl/scene/include.h"

#include "dsl/models/scene_path.h"
#include "dsl/report/limits.h"
#include "dsl/yaml/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

namespace patchlight {
namespace {

namespace fs = std::filesystem;

struct Reader {
  const Context& context;
  Tree& tree;
  int64_t unit = 0;             // choice of `units` in the scene itself
  std::vector<fs::path> chain;  // files that are being read, canonical, the scene first
  std::set<std::pair<std::string, std::string>> read;  // canonical path and prefix
  std::vector<SceneFile> files;
};

// Reads and parses a file; kNone after errors.
uint32_t parse_file(Reader& reader, uint32_t node, const fs::path& path) {
  Messages& messages = reader.context.messages;
  const uint32_t file =
      add_scene_file(messages, place_of(reader.tree, node), path, &Limits::scene_bytes, messages.scene_bytes);
  if (file == kNone) return kNone;
  if (!check_source(messages, file)) return kNone;
  const uint32_t root = parse_tree(messages, file, reader.tree);
  if (root != kNone && reader.tree.nodes[root].kind != NodeKind::kMap) {
    add_error(messages, {file, 1, 1}, "root-not-map",
              fmt::format("an included file is a map, got {}", describe(reader.tree, root)));
    return kNone;
  }
  return root;
}

// What an included file may not say: it adds to the scene, and leaves its settings alone.
void check_included(const Reader& reader, const MapValues& map) {
  for (const std::string_view key : {"sky", "sun", "camera", "cameras", "solver", "output", "expect"})
    if (const uint32_t node = value_of(map, key).node; node != kNone)
      add_error(reader.context.messages, place_of(reader.tree, node), "unknown-key",
                fmt::format("'{}' belongs into the scene itself, not into a file that it includes", key));
  check_version_known(reader.context, map);
  const Value& units = value_of(map, "units");
  if (units.node != kNone && units.integer[0] != reader.unit)
    add_error(reader.context.messages, place_of(reader.tree, units.node), "bad-unit",
              "an included file uses the unit of the scene that includes it");
}

void read_file(Reader& reader, uint32_t root, const std::string& prefix);

void read_entry(Reader& reader, uint32_t entry, const std::string& outer) {
  std::string name, prefix = outer;
  uint32_t place = entry;
  if (reader.tree.nodes[entry].kind == NodeKind::kMap) {
    const MapValues map = read_map(reader.context, entry, kIncludeKeys);
    if (!map.good) return;
    place = value_of(map, "file").node;
    name = text_of(reader.tree, place);
    if (has(map, "as")) prefix += std::string(text_of(reader.tree, value_of(map, "as").node)) + ".";
  } else if (!read_text(reader.context, entry, name)) {
    return;
  }
  const fs::path path = find_scene_file(reader.context.messages, place_of(reader.tree, place), name,
                                        reader.chain.back().parent_path(), "include-not-found");
  if (path.empty()) return;
  const auto fail = [&](std::string_view slug, std::string message) {
    add_error(reader.context.messages, place_of(reader.tree, place), slug, std::move(message));
  };
  if (std::find(reader.chain.begin(), reader.chain.end(), path) != reader.chain.end()) {
    std::string chain;
    for (const fs::path& link : reader.chain) chain += escape_text(link.filename().string()) + " -> ";
    return fail("include-cycle",
                fmt::format("files include each other: {}{}", chain, escape_text(path.filename().string())));
  }
  const Limits& limits = reader.context.messages.limits;
  if (reader.read.size() >= limits.includes)
    return fail("too-many-includes",
                fmt::format("more than the limit of {}", limit_text(limits, &Limits::includes)));
  if (reader.chain.size() > limits.include_depth)
    return fail("too-many-includes", fmt::format("files include files deeper than the limit of {}",
                                                 limit_text(limits, &Limits::include_depth)));
  if (!reader.read.emplace(path.string(), prefix).second) return;
  const uint32_t root = parse_file(reader, place, path);
  if (root == kNone) return;
  reader.chain.push_back(path);
  read_file(reader, root, prefix);
  reader.chain.pop_back();
}

void read_file(Reader& reader, uint32_t root, const std::string& prefix) {
  SceneFile file{prefix, read_map(reader.context, root, kSceneKeys)};
  if (reader.chain.size() == 1)
    reader.unit = value_of(file.map, "units").integer[0];
  else
    check_included(reader, file.map);
  const uint32_t list = value_of(file.map, "include").node;
  if (list != kNone && reader.tree.nodes[list].kind == NodeKind::kList)
    for (uint32_t entry = reader.tree.nodes[list].first; entry != kNone;
         entry = reader.tree.nodes[entry].next)
      read_entry(reader, entry, prefix);
  reader.files.push_back(std::move(file));
}

}  // namespace

std::vector<SceneFile> read_includes(const Context& context, Tree& tree, uint32_t root,
                                     const std::string& path) {
  std::error_code error;
  const fs::path scene =
      fs::weakly_canonical(fs::absolute(path == "." ? fs::path("-") : fs::path(path), error), error);
  context.messages.files[0].folder = scene.parent_path().string();
  Reader reader{context, tree, 0, {scene}, {}, {}};
  read_file(reader, root, "");
  return std::move(reader.files);
}

}  // namespace patchlight
