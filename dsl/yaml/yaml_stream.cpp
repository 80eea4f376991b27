// A scene's text as a stream in one part or two.
#include "dsl/yaml/yaml_stream.h"

#include <algorithm>

namespace patchlight {
namespace {

// The line of the first thing in a text that is neither blank nor a comment, if that is a bracket: where it
// begins.
size_t find_root_bracket(std::string_view text) {
  size_t at = 0;
  while ((at = text.find_first_not_of(" \r\n", at)) != std::string_view::npos && text[at] == '#')
    at = std::min(text.find('\n', at), text.size());
  if (at == std::string_view::npos || (text[at] != '{' && text[at] != '[')) return std::string_view::npos;
  return text.find_last_of('\n', at) + 1;
}

}  // namespace

YamlStream::YamlStream(std::string& text) : stream(this), text_(text) {
  const size_t root = find_root_bracket(text);
  if (root == std::string_view::npos) {
    setg(text.data(), text.data(), text.data() + text.size());
    return;
  }
  inserted_ = "--- ";
  root_ = static_cast<int>(root);
  root_line_ = static_cast<int>(std::count(text.begin(), text.begin() + root_, '\n'));
  setg(inserted_.data(), inserted_.data(), inserted_.data() + inserted_.size());
}

YamlStream::int_type YamlStream::underflow() {
  if (eback() != inserted_.data()) return traits_type::eof();
  setg(text_.data() + root_, text_.data() + root_, text_.data() + text_.size());
  return traits_type::to_int_type(*gptr());
}

YAML::Mark YamlStream::true_mark(YAML::Mark mark) const {
  if (inserted_.empty() || mark.is_null()) return mark;
  const auto length = static_cast<int>(inserted_.size());
  mark.pos = root_ + std::max(mark.pos - length, 0);
  if (mark.line == 0) mark.column = std::max(mark.column - length, 0);
  mark.line += root_line_;
  return mark;
}

}  // namespace patchlight
