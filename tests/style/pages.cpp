// What pages for people name is there: files of the tree, and what links lead to.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// All README.md of the sources, and the pages of the root.
std::vector<fs::path> find_pages() {
  const fs::path root = PATCHLIGHT_SOURCE_DIR;
  std::vector<fs::path> pages;
  const auto add = [&](const fs::directory_entry& entry) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  };
  for (const auto& entry : fs::directory_iterator(root)) add(entry);
  for (const char* folder : {"engine", "dsl", "tools", "scenes"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) add(entry);
  std::sort(pages.begin(), pages.end());
  return pages;
}

std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// What the first bracket of a pattern matches, wherever it does.
std::vector<std::string> find_all(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (auto match = std::sregex_iterator(text.begin(), text.end(), pattern); match != std::sregex_iterator();
       ++match)
    found.push_back((*match)[1]);
  return found;
}

// A heading as links name it: small letters, no punctuation, - for blanks.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading)
    if (c == ' ')
      anchor += '-';
    else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return anchor;
}

bool has_heading(const fs::path& page, const std::string& anchor) {
  static const std::regex heading("(?:^|\n)#+ ([^\n]*)");
  const std::vector<std::string> headings = find_all(read(page), heading);
  return std::any_of(headings.begin(), headings.end(),
                     [&](const std::string& text) { return anchor_of(text) == anchor; });
}

}  // namespace

TEST_CASE("pages: a path of the tree that a page names is there") {
  // Written from the root, in backticks; NAME and * stand for any.
  const std::regex path("`((?:engine|dsl|tools|scenes|tests)/[A-Za-z0-9_./-]+)[` ]");
  size_t count = 0;
  for (const fs::path& page : find_pages())
    for (const std::string& named : find_all(read(page), path)) {
      if (named.find("NAME") != std::string::npos) continue;
      ++count;
      CHECK_MESSAGE(fs::exists(fs::path(PATCHLIGHT_SOURCE_DIR) / named), page, " names ", named);
    }
  CHECK(count > 50);
}

TEST_CASE("pages: a link leads to a file, and to a heading in it") {
  const std::regex link(R"(\]\(([^)\s]+)\))");
  size_t count = 0;
  for (const fs::path& page : find_pages())
    for (const std::string& target : find_all(read(page), link)) {
      if (target.starts_with("http")) continue;
      ++count;
      const size_t hash = std::min(target.find('#'), target.size());
      const fs::path file = hash == 0 ? page : page.parent_path() / target.substr(0, hash);
      CHECK_MESSAGE(fs::exists(file), page, " leads to ", target);
      if (hash < target.size())
        CHECK_MESSAGE(has_heading(file, target.substr(hash + 1)), page, " leads to ", target);
    }
  CHECK(count > 50);
}
