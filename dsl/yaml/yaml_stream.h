// A scene's text as the stream that the YAML parser reads, and the parser's marks back to places in the text.
#pragma once

#include <yaml-cpp/mark.h>

#include <istream>
#include <streambuf>
#include <string>

namespace patchlight {

// Where the document's root is a bracket (JSON), the parser takes all of it for a key until it ends, and
// keeps every token: 36 times the text. Behind a "---" there can be no key, so one is put before such a root,
// and the comments above it are left out. The text is not copied: it must outlive the stream.
class YamlStream : std::streambuf {
 public:
  explicit YamlStream(std::string& text);

  std::istream stream;

  // A mark as it would be in the text itself.
  YAML::Mark true_mark(YAML::Mark mark) const;

 protected:
  int_type underflow() override;

 private:
  std::string& text_;
  std::string inserted_;  // in front; empty where the root is no bracket
  int root_ = 0;          // where the line of its bracket begins
  int root_line_ = 0;     // 0-based
};

}  // namespace patchlight
