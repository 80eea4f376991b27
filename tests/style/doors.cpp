// Where each foreign library may be included, and what the engine may not do.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

struct Include {
  std::string file;    // relative to the root of the sources
  std::string header;  // as written between the quotes or brackets
  bool is_ours;        // in quotes
};

std::vector<Include> find_includes() {
  const std::filesystem::path root = PATCHLIGHT_SOURCE_DIR;
  const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const char* folder : {"engine", "dsl", "tools"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".h" && ending != ".cpp") continue;
      std::ifstream file(entry.path());
      std::smatch match;
      for (std::string line; std::getline(file, line);)
        if (std::regex_search(line, match, pattern))
          includes.push_back(
              {std::filesystem::relative(entry.path(), root).string(), match[2], match[1] == "\""});
    }
  return includes;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  for (const std::string& beginning : beginnings)
    if (text.starts_with(beginning)) return true;
  return false;
}

}  // namespace

TEST_CASE("each foreign library has one door") {
  struct Door {
    const char* headers;             // regular expression
    std::vector<std::string> files;  // beginnings of the paths that may include them
  };
  const std::vector<Door> doors = {
      {"^(tbb|oneapi)/", {"engine/base/parallel."}},
      {"^embree", {"engine/trace/tracer."}},
      {"^glm/", {"engine/base/vector.h"}},
      {"^Eigen/", {"engine/base/linear_system.cpp"}},
      {"^yaml-cpp/", {"dsl/yaml/"}},
      {"^stb_image", {"tools/image/image_writer.cpp"}},
      {"^stb_truetype", {"tools/image/lettering.cpp"}},
      {"^gif_lib", {"tools/export/export_gif.cpp"}},
      {"^tinyexr", {"tools/export/export_exr.cpp"}},
      {"^zlib", {"tools/export/export_html.cpp"}},
      {"^CLI/", {"tools/cli/command_line.cpp"}},
      {"^nlohmann/", {"tools/base/json.h"}},
      {"^benchmark/", {"tools/bench/measure."}},
  };
  const std::vector<Include> includes = find_includes();
  REQUIRE(includes.size() > 50);
  for (const Door& door : doors) {
    size_t used = 0;
    for (const Include& include : includes) {
      if (!std::regex_search(include.header, std::regex(door.headers))) continue;
      ++used;
      CHECK_MESSAGE(starts_with_any(include.file, door.files), include.file, " includes ", include.header);
    }
    CHECK_MESSAGE(used > 0, "nothing includes ", door.headers, ": is its name right?");
  }
}

TEST_CASE("the engine neither prints nor exits") {
  const std::filesystem::path root = PATCHLIGHT_SOURCE_DIR;
  const std::regex forbidden(
      R"(\b(printf|puts|std::cout|std::cerr|std::clog|exit|abort|terminate)\s*(\(|<<))");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "engine")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      CHECK_MESSAGE(!std::regex_search(line.substr(0, line.find("//")), forbidden), entry.path().string(),
                    ": ", line);
  }
}
