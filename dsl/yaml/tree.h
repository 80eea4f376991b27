// Text to a located tree: YAML's events in one arena of small nodes, in the order of the file.
#pragma once

#include "dsl/report/messages.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

enum class NodeKind : uint8_t { kNull, kScalar, kList, kMap };

// A node. For lists and maps `first` is the first child (maps: key, value, key, value ...) and `count` the
// number of children; for scalars they are the range of the text. An alias is a node of its own that shares
// its anchor's children.
struct Node {
  uint32_t first = ~uint32_t{0};
  uint32_t count = 0;
  uint32_t next = ~uint32_t{0};  // the following sibling, or kNone
  uint32_t line = 0;             // 1-based
  uint32_t column = 0;           // 1-based, bytes
  NodeKind kind = NodeKind::kNull;
  bool quoted = false;
};

// All files of a scene share one tree: a file's nodes are a range of rows.
struct Tree {
  std::vector<Node> nodes;
  std::string text;                  // of all scalars, end to end
  std::vector<uint32_t> file_first;  // file -> its first node
};

// Parses messages.files[file] (which prescan has passed) behind the nodes that the tree has. Returns the root
// or kNone for an empty document or after errors: yaml-syntax, yaml-undefined-alias, alias-cycle,
// alias-expansion, duplicate-key, key-not-string, merge-key-unsupported, unknown-tag, multiple-documents,
// too-deep, memory-limit.
uint32_t parse_tree(Messages& messages, uint32_t file, Tree& tree);

// The text of a scalar; empty for all other kinds. Valid until the tree grows.
std::string_view text_of(const Tree& tree, uint32_t node);

// Where a node stands.
Place place_of(const Tree& tree, uint32_t node);

// Child number `index` of a list, walking from its first.
uint32_t child_of(const Tree& tree, uint32_t list, uint32_t index);

// What a message calls a node: "the text 'abc'", "a list", "a map", "nothing".
std::string describe(const Tree& tree, uint32_t node);

}  // namespace patchlight
