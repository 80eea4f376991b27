// A folder of its own for a test, and small helpers for the files in it.
#pragma once

#include <string>

namespace patchlight::testing {

// Made empty, removed with everything in it at the end.
struct Folder {
  std::string path;
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();
  std::string operator/(const std::string& name) const { return path + "/" + name; }
};

// The bytes of a file; fails the test where there is none.
std::string read_bytes(const std::string& path);
void write_bytes(const std::string& path, const std::string& bytes);
// Names in a folder, sorted, hidden ones too, with a space between each two.
std::string list_names(const std::string& path);

}  // namespace patchlight::testing
