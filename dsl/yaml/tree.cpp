// YAML events to the tree. Own code instead of YAML::Node: that one is slow, hides duplicate keys and loses
// places.
#include "dsl/yaml/tree.h"

#include "dsl/report/limits.h"
#include "dsl/yaml/yaml_errors.h"
#include "dsl/yaml/yaml_stream.h"
#include "engine/base/vector.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <unordered_map>

namespace patchlight {
namespace {

constexpr size_t kKeysComparedPairwise = 12;  // more keys than that are compared by hash

struct StopReading {};  // an error that leaves nothing to go on with, already reported

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(Messages& messages, uint32_t file, const YamlStream& stream, Tree& tree)
      : messages_(messages), file_(file), stream_(stream), tree_(tree) {}

  uint32_t root = kNone;

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ == 0) return;
    const Place place = place_at(mark);
    const auto offset = static_cast<size_t>(stream_.true_mark(mark).pos);
    if (messages_.files[file_].text.compare(offset, 3, "---") == 0)
      stop(place, "multiple-documents",
           "a second document begins here; one file holds one scene: take the '---' out");
    stop(place, "yaml-syntax",
         "this does not belong to what stands before it; is a ':' or a line break missing?");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Place place = place_at(mark);
    // The parser puts an empty value where the next token stands, often lines below: its key says more.
    const bool is_value = !open_.empty() && tree_.nodes[open_.back().node].kind == NodeKind::kMap &&
                          tree_.nodes[open_.back().node].count % 2 == 1;
    if (is_value && place.line != tree_.nodes[last_child()].line) {
      place.line = tree_.nodes[last_child()].line;
      place.column = tree_.nodes[last_child()].column;
    }
    const uint64_t before = expanded_;
    const uint32_t node = add_node(place, NodeKind::kNull);
    if (anchor != YAML::NullAnchor) close_anchor(anchor, node, before, 1);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const Place place = place_at(mark);
    if (anchor >= anchors_.size() || anchors_[anchor].node == kNone)
      stop(place, "alias-cycle", "this alias stands inside the node that it names, which would never end");
    const Anchor target = anchors_[anchor];
    alias_nodes_ += target.expanded;
    if (alias_nodes_ > messages_.limits.alias_values)
      stop(place, "alias-expansion",
           fmt::format("aliases stand for more than the limit of {}",
                       limit_text(messages_.limits, &Limits::alias_values)));
    if (open_.size() + target.height > messages_.limits.nesting) stop_too_deep(place);
    const Node source = tree_.nodes[target.node];
    const uint32_t node = add_node(place, source.kind);
    expanded_ += target.expanded - 1;
    tree_.nodes[node].first = source.first;
    tree_.nodes[node].count = source.count;
    tree_.nodes[node].quoted = source.quoted;
    raise_height(target.height);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const Place place = place_at(mark);
    const bool quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    if (!quoted && tag != "?") check_tag(place, tag, {"float", "int"});
    const uint64_t before = expanded_;
    const uint32_t node = add_node(place, NodeKind::kScalar);
    Node& row = tree_.nodes[node];
    row.first = static_cast<uint32_t>(tree_.text.size());
    row.count = static_cast<uint32_t>(value.size());
    row.quoted = quoted;
    tree_.text += value;
    if (!quoted && value == "<<" && is_key(node))
      stop(place, "merge-key-unsupported",
           "merge keys (<<) are not part of the language; write the keys out");
    if (anchor != YAML::NullAnchor) close_anchor(anchor, node, before, 1);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_container(mark, tag, anchor, NodeKind::kList);
  }
  void OnSequenceEnd() override { close_container(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open_container(mark, tag, anchor, NodeKind::kMap);
  }
  void OnMapEnd() override {
    check_keys(open_.back().node);
    close_container();
  }

  [[noreturn]] void stop(Place place, std::string_view slug, std::string message) {
    add_error(messages_, place, slug, std::move(message));
    throw StopReading{};
  }
  [[noreturn]] void stop_too_deep(Place place) {
    stop(place, "too-deep",
         fmt::format("nested deeper than the limit of {}", limit_text(messages_.limits, &Limits::nesting)));
  }

 private:
  struct Open {
    uint32_t node = kNone;
    uint32_t last = kNone;  // its latest child
    YAML::anchor_t anchor = YAML::NullAnchor;
    uint64_t expanded_before = 0;
    uint32_t height = 1;
  };
  struct Anchor {
    uint32_t node = kNone;  // kNone: still open
    uint64_t expanded = 0;  // nodes below and with it, aliases followed
    uint32_t height = 0;
  };

  Place place_at(const YAML::Mark& parser_mark) const {
    const YAML::Mark mark = stream_.true_mark(parser_mark);
    return {file_, static_cast<uint32_t>(mark.line + 1), static_cast<uint32_t>(mark.column + 1)};
  }
  uint32_t last_child() const { return open_.back().last; }
  bool is_key(uint32_t node) const {
    if (open_.empty()) return false;
    const Node& parent = tree_.nodes[open_.back().node];
    return parent.kind == NodeKind::kMap && open_.back().last == node && parent.count % 2 == 1;
  }

  void check_tag(Place place, const std::string& tag, std::initializer_list<std::string_view> known) {
    constexpr std::string_view core = "tag:yaml.org,2002:";
    const std::string_view rest =
        std::string_view(tag).starts_with(core) ? std::string_view(tag).substr(core.size()) : "";
    if (std::find(known.begin(), known.end(), rest) != known.end()) return;
    add_error(messages_, place, "unknown-tag",
              fmt::format("tags are not part of the language; take '{}' out", escape_text(tag)));
  }

  uint32_t add_node(Place place, NodeKind kind) {
    if (tree_.nodes.size() >= messages_.limits.values)
      stop(place, "memory-limit",
           fmt::format("more than the limit of {}", limit_text(messages_.limits, &Limits::values)));
    const auto node = static_cast<uint32_t>(tree_.nodes.size());
    tree_.nodes.push_back({kNone, 0, kNone, place.line, place.column, kind, false});
    ++expanded_;
    if (open_.empty()) {
      root = node;
      return node;
    }
    Open& parent = open_.back();
    if (parent.last == kNone)
      tree_.nodes[parent.node].first = node;
    else
      tree_.nodes[parent.last].next = node;
    parent.last = node;
    ++tree_.nodes[parent.node].count;
    return node;
  }

  void open_container(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, NodeKind kind) {
    const Place place = place_at(mark);
    if (!tag.empty() && tag != "?" && tag != "!") check_tag(place, tag, {"seq", "map"});
    if (open_.size() >= messages_.limits.nesting) stop_too_deep(place);
    const uint64_t before = expanded_;
    const uint32_t node = add_node(place, kind);
    open_.push_back({node, kNone, anchor, before, 1});
    if (anchor != YAML::NullAnchor && anchors_.size() <= anchor) anchors_.resize(anchor + 1);
  }

  void close_container() {
    const Open closed = open_.back();
    open_.pop_back();
    if (closed.anchor != YAML::NullAnchor)
      close_anchor(closed.anchor, closed.node, closed.expanded_before, closed.height);
    raise_height(closed.height);
  }

  void close_anchor(YAML::anchor_t anchor, uint32_t node, uint64_t expanded_before, uint32_t height) {
    if (anchors_.size() <= anchor) anchors_.resize(anchor + 1);
    anchors_[anchor] = {node, expanded_ - expanded_before, height};
  }
  void raise_height(uint32_t child_height) {
    if (!open_.empty()) open_.back().height = std::max(open_.back().height, child_height + 1);
  }

  void check_keys(uint32_t map) {
    keys_.clear();
    for (uint32_t key = tree_.nodes[map].first; key != kNone;) {
      if (tree_.nodes[key].kind != NodeKind::kScalar)
        add_error(messages_, place_of(tree_, key), "key-not-string",
                  fmt::format("a key is a name, not {}", describe(tree_, key)));
      else
        keys_.push_back(key);
      const uint32_t value = tree_.nodes[key].next;
      key = value == kNone ? kNone : tree_.nodes[value].next;
    }
    if (keys_.size() <= kKeysComparedPairwise) {
      for (size_t i = 1; i < keys_.size(); ++i)
        for (size_t j = 0; j < i; ++j)
          if (text_of(tree_, keys_[i]) == text_of(tree_, keys_[j])) {
            report_duplicate(keys_[j], keys_[i]);
            break;
          }
      return;
    }
    std::unordered_map<std::string_view, uint32_t> seen(keys_.size() * 2);
    for (const uint32_t key : keys_) {
      const auto [row, is_new] = seen.try_emplace(text_of(tree_, key), key);
      if (!is_new) report_duplicate(row->second, key);
    }
  }
  void report_duplicate(uint32_t first, uint32_t second) {
    add_error(messages_, place_of(tree_, second), "duplicate-key",
              fmt::format("key '{}' is also defined at line {}; keep one of the two",
                          escape_text(text_of(tree_, second)), tree_.nodes[first].line));
  }

  Messages& messages_;
  uint32_t file_;
  const YamlStream& stream_;
  Tree& tree_;
  std::vector<Open> open_;
  std::vector<Anchor> anchors_;
  std::vector<uint32_t> keys_;
  uint64_t expanded_ = 0;     // nodes so far, aliases followed
  uint64_t alias_nodes_ = 0;  // of them by aliases
  int documents_ = 0;
};

}  // namespace

uint32_t parse_tree(Messages& messages, uint32_t file, Tree& tree) {
  SourceFile& source = messages.files[file];
  tree.file_first.resize(std::max<size_t>(tree.file_first.size(), file + 1),
                         static_cast<uint32_t>(tree.nodes.size()));
  const size_t errors_before = messages.error_count;
  YamlStream text(source.text);
  TreeBuilder builder(messages, file, text, tree);
  try {
    YAML::Parser parser(text.stream);
    // Two documents at most: the second one is an error, and asking further may never end.
    if (parser.HandleNextDocument(builder)) parser.HandleNextDocument(builder);
  } catch (const StopReading&) {
    return kNone;
  } catch (const YAML::Exception& error) {
    report_yaml_error(messages, file, {text.true_mark(error.mark), error.msg});
    return kNone;
  }
  return messages.error_count == errors_before ? builder.root : kNone;
}

std::string_view text_of(const Tree& tree, uint32_t node) {
  const Node& row = tree.nodes[node];
  if (row.kind != NodeKind::kScalar) return {};
  return std::string_view(tree.text).substr(row.first, row.count);
}

Place place_of(const Tree& tree, uint32_t node) {
  const auto after = std::upper_bound(tree.file_first.begin(), tree.file_first.end(), node);
  return {static_cast<uint32_t>(after - tree.file_first.begin() - 1), tree.nodes[node].line,
          tree.nodes[node].column};
}

uint32_t child_of(const Tree& tree, uint32_t list, uint32_t index) {
  uint32_t child = tree.nodes[list].first;
  while (index-- > 0) child = tree.nodes[child].next;
  return child;
}

std::string describe(const Tree& tree, uint32_t node) {
  switch (tree.nodes[node].kind) {
    case NodeKind::kList:
      return "a list";
    case NodeKind::kMap:
      return "a map";
    case NodeKind::kScalar:
      return fmt::format("the {} '{}'", tree.nodes[node].quoted ? "quoted text" : "text",
                         escape_text(text_of(tree, node)));
    case NodeKind::kNull:
      break;
  }
  return "nothing";
}

}  // namespace patchlight
