// Files that are no scene at all.
#include "dsl/yaml/source.h"

#include "dsl/report/limits.h"

#include <doctest/doctest.h>

namespace patchlight::test {
namespace {

std::string slug_of_file(const std::string& path) {
  try {
    read_bytes(path, 1 << 20, "1 MiB");
  } catch (const UserError& error) {
    return error.diagnostics.front().slug;
  }
  return "";
}

TEST_CASE("what cannot be a scene file is refused before it is read") {
  CHECK(slug_of_file("/nonexistent/nope.yaml") == "cannot-open");
  CHECK(slug_of_file("/") == "not-a-regular-file");
  CHECK(slug_of_file("/dev/zero") == "file-too-large");
}

TEST_CASE("a text above the limit is refused") {
  Messages messages;
  messages.files.push_back({"t.yaml", std::string(Limits{}.scene_bytes + 1, ' ')});
  CHECK(!check_source(messages, 0));
  CHECK(messages.errors[0].slug == "file-too-large");
}

TEST_CASE("a byte order mark is cut off") {
  Messages messages;
  messages.files.push_back({"t.yaml",
                            "\xef\xbb\xbf"
                            "a: 1\n"});
  CHECK(check_source(messages, 0));
  CHECK(messages.files[0].text == "a: 1\n");
}

}  // namespace
}  // namespace patchlight::test
