// The layout as a test: who may include whom, and where each foreign library may be included.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
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

// A folder, and the folders that it builds on.
struct Room {
  std::string name;
  std::vector<std::string> uses;
};

// The room of a file, the innermost one that holds it; empty: none.
std::string find_room(const std::string& file, const std::vector<Room>& rooms) {
  std::string best;
  for (const Room& room : rooms)
    if (file.starts_with(room.name + "/") && room.name.size() > best.size()) best = room.name;
  return best;
}

// Where an included header of ours is: beside the file, or under the root of the sources; empty: neither, the
// build makes it.
std::string locate(const Include& include) {
  const std::filesystem::path root = PATCHLIGHT_SOURCE_DIR;
  const std::filesystem::path beside = std::filesystem::path(include.file).parent_path() / include.header;
  if (std::filesystem::exists(root / beside)) return beside.string();
  return std::filesystem::exists(root / include.header) ? include.header : "";
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
      {"^yaml-cpp/", {"dsl/"}},
      {"^stb_image", {"tools/image_writer.cpp"}},
      {"^stb_truetype", {"tools/lettering.cpp"}},
      {"^gif_lib", {"tools/export_gif.cpp"}},
      {"^tinyexr", {"tools/export_exr.cpp"}},
      {"^zlib", {"tools/export_html.cpp"}},
      {"^CLI/", {"tools/command_line.cpp"}},
      {"^nlohmann/", {"tools/json.h"}},
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

TEST_CASE("rooms: a folder includes what its row names, and what that may include") {
  const std::vector<Room> rooms = {
      {"engine/base", {}},
      {"engine", {"engine/base"}},  // tables.h, settings.h
      {"engine/trace", {"engine"}},
      {"engine/mesh", {"engine/trace"}},
      {"engine/factors", {"engine/trace"}},
      {"engine/light", {"engine/mesh", "engine/factors"}},
      {"engine/film", {"engine/mesh", "engine/factors"}},
      {"engine/transport", {"engine/light"}},
      {"engine/solve", {"engine/film", "engine/transport"}},
      {"dsl", {"engine"}},  // it fills tables and needs no kernel
      {"tools", {"dsl", "engine/solve"}},
  };
  std::map<std::string, std::set<std::string>> allowed;
  for (const Room& room : rooms) {
    std::set<std::string>& mine = allowed[room.name];
    mine.insert(room.name);
    for (const std::string& used : room.uses) {
      // Who names only rooms above makes no circle.
      REQUIRE_MESSAGE((allowed.contains(used) && used != room.name), room.name, " stands before ", used);
      mine.insert(allowed[used].begin(), allowed[used].end());
    }
  }
  for (const Include& include : find_includes()) {
    if (!include.is_ours) continue;
    CHECK_MESSAGE(include.header.find("..") == std::string::npos, include.file, " includes ", include.header);
    const std::string header = locate(include);
    if (header.empty()) continue;
    const std::string from = find_room(include.file, rooms), to = find_room(header, rooms);
    REQUIRE_MESSAGE(!from.empty(), include.file, " lies in no room");
    CHECK_MESSAGE(allowed[from].contains(to), "room ", from, " may not include room ",
                  to.empty() ? "(none)" : to, ": ", include.file, " includes ", include.header);
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
