// Values of the command line put into the tree of a scene.
#include "dsl/language/overrides.h"

#include "dsl/yaml/source.h"
#include "engine/base/vector.h"

#include <fmt/format.h>

#include <charconv>

namespace patchlight {
namespace {

uint32_t push_node(Tree& tree, Node node) {
  node.line = node.column = 1;
  tree.nodes.push_back(node);
  return static_cast<uint32_t>(tree.nodes.size() - 1);
}

uint32_t push_key(Tree& tree, std::string_view text, uint32_t value) {
  Node key;
  key.kind = NodeKind::kScalar;
  key.first = static_cast<uint32_t>(tree.text.size());
  key.count = static_cast<uint32_t>(text.size());
  key.next = value;
  tree.text += text;
  return push_node(tree, key);
}

// The longest key of a map that a path begins with (names may have dots); kNone when there is none.
uint32_t find_key(const Tree& tree, uint32_t map, std::string_view path) {
  uint32_t best = kNone;
  for (uint32_t key = tree.nodes[map].first; key != kNone;) {
    const std::string_view word = text_of(tree, key);
    const bool fits = path.starts_with(word) && (path.size() == word.size() || path[word.size()] == '.');
    if (fits && (best == kNone || word.size() > text_of(tree, best).size())) best = key;
    key = tree.nodes[tree.nodes[key].next].next;
  }
  return best;
}

// Ids of a list's items.
std::vector<std::string> list_ids(const Tree& tree, uint32_t list) {
  std::vector<std::string> ids;
  for (uint32_t item = tree.nodes[list].first; item != kNone; item = tree.nodes[item].next) {
    if (tree.nodes[item].kind != NodeKind::kMap) continue;
    const uint32_t id = find_key(tree, item, "id");
    if (id != kNone) ids.emplace_back(text_of(tree, tree.nodes[id].next));
  }
  return ids;
}

// The item of a list that a path's first word names, by number or by id.
uint32_t find_item(const Tree& tree, uint32_t list, std::string_view path, std::string_view& word) {
  word = path.substr(0, path.find('.'));
  uint32_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool by_number = error == std::errc{} && end == word.data() + word.size();
  uint32_t k = 0;
  for (uint32_t item = tree.nodes[list].first; item != kNone; item = tree.nodes[item].next, ++k) {
    if (by_number && k == number) return item;
    if (by_number || tree.nodes[item].kind != NodeKind::kMap) continue;
    const uint32_t id = find_key(tree, item, "id");
    if (id == kNone) continue;
    const std::string_view name = text_of(tree, tree.nodes[id].next);
    if (path.starts_with(name) && (path.size() == name.size() || path[name.size()] == '.')) {
      word = path.substr(0, name.size());
      return item;
    }
  }
  return kNone;
}

// Adds the path's words as nested maps, with the value innermost, to a map.
void add_value(Tree& tree, uint32_t map, std::string_view path, uint32_t value) {
  for (size_t dot = path.rfind('.'); dot != std::string_view::npos; dot = path.rfind('.')) {
    Node inner;
    inner.kind = NodeKind::kMap;
    inner.first = push_key(tree, path.substr(dot + 1), value);
    inner.count = 2;
    value = push_node(tree, inner);
    path = path.substr(0, dot);
  }
  const uint32_t key = push_key(tree, path, value);
  uint32_t last = kNone;
  for (uint32_t child = tree.nodes[map].first; child != kNone; child = tree.nodes[child].next) last = child;
  if (last == kNone)
    tree.nodes[map].first = key;
  else
    tree.nodes[last].next = key;
  tree.nodes[map].count += 2;
}

// What is wrong with a path that names no item of a list.
std::string no_item_text(const Tree& tree, uint32_t list, std::string_view word) {
  const std::string near = did_you_mean(word, list_ids(tree, list));
  return fmt::format("the list of {} there has no '{}': items go by number, from 0, or by id{}",
                     tree.nodes[list].count, escape_text(word),
                     near.empty() ? "" : fmt::format("; did you mean '{}'?", escape_text(near)));
}

// Puts `value` where `path` says. Returns what is wrong with the path, or an empty text.
std::string set_value(Tree& tree, uint32_t node, std::string_view path, uint32_t value) {
  for (;;) {
    if (tree.nodes[node].kind == NodeKind::kMap) {
      const uint32_t key = find_key(tree, node, path);
      if (key == kNone) {
        add_value(tree, node, path, value);
        return {};
      }
      const uint32_t old = tree.nodes[key].next;
      const size_t length = text_of(tree, key).size();
      if (path.size() == length) {
        tree.nodes[value].next = tree.nodes[old].next;
        tree.nodes[key].next = value;
        return {};
      }
      path.remove_prefix(length + 1);
      node = old;
    } else if (tree.nodes[node].kind == NodeKind::kList) {
      std::string_view word;
      const uint32_t item = find_item(tree, node, path, word);
      if (item == kNone) return no_item_text(tree, node, word);
      if (path.size() <= word.size()) return "the path ends at an item of a list; name one of its keys";
      path.remove_prefix(word.size() + 1);
      node = item;
    } else {
      return fmt::format("'{}' is looked for in {}, which has no parts", escape_text(path),
                         describe(tree, node));
    }
  }
}

}  // namespace

void apply_overrides(Messages& messages, const std::vector<std::string>& overrides, uint32_t root,
                     Tree& tree) {
  for (const std::string& text : overrides) {
    const size_t equals = text.find('=');
    const std::string path = text.substr(0, equals);
    const bool good = equals != std::string::npos && !path.empty() && !path.starts_with('.') &&
                      !path.ends_with('.') && path.find("..") == std::string::npos;
    if (!good) {
      add_command_line_error(messages, "usage",
                             fmt::format("--set {}: expected PATH=VALUE", escape_text(text)));
      continue;
    }
    const auto file = static_cast<uint32_t>(messages.files.size());
    messages.files.push_back({"--set " + escape_text(path), text.substr(equals + 1), true});
    if (!check_source(messages, file)) continue;
    const size_t errors_before = messages.error_count;
    const uint32_t value = parse_tree(messages, file, tree);
    if (messages.error_count > errors_before) continue;
    const std::string mistake = value == kNone ? "the value is missing" : set_value(tree, root, path, value);
    if (!mistake.empty())
      add_command_line_error(messages, "usage", fmt::format("--set {}: {}", escape_text(text), mistake));
  }
}

}  // namespace patchlight
