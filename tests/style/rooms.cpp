// The house as a test: a table of who may include whom, no circle among files, and a word at each door.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// A folder, and those that it builds on: it may include them, and what they may include. Of other rooms it
// may include single headers.
struct Room {
  std::string name;
  std::vector<std::string> uses;
  std::vector<std::string> headers = {};
};

// Who names only rooms above makes no circle.
const std::vector<Room> kRooms = {
    {"engine/base", {}},
    {"engine", {"engine/base"}},  // tables.h, settings.h, sky.h
    {"engine/trace", {"engine"}},
    {"engine/mesh", {"engine/trace"}},
    {"engine/factors", {"engine/trace"}},
    {"engine/light", {"engine/mesh", "engine/factors"}},
    {"engine/film", {"engine/mesh", "engine/factors"}},
    {"engine/transport", {"engine/light"}},
    {"engine/solve", {"engine/film", "engine/transport"}},
    {"dsl/report", {"engine"}},  // the loader fills tables and needs no kernel
    {"dsl/yaml", {"dsl/report"}},
    {"dsl/language", {"dsl/yaml"}},
    {"dsl/polygons", {"dsl/yaml"}},
    {"dsl/models", {"dsl/language", "dsl/polygons"}},
    {"dsl/shapes", {"dsl/models"}},
    {"dsl/scene", {"dsl/shapes"}, {"engine/film/lens.h"}},  // the names of projections
    {"tools/base", {"dsl/scene", "engine/solve"}},
    {"tools/image", {"tools/base"}},
    {"tools/export", {"tools/image"}},
    {"tools/render", {"tools/export"}},
    {"tools/bench", {"tools/render"}},
    {"tools/verbs", {"tools/bench"}},
    {"tools/cli", {"tools/verbs"}},
    {"tools/compare", {"tools/base"}},
};

std::string room_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

// A room -> the rooms and the single headers that it may include.
using Allowed = std::map<std::string, std::set<std::string>>;

Allowed find_allowed() {
  Allowed allowed;
  for (const Room& room : kRooms) {
    std::set<std::string>& mine = allowed[room.name];
    mine.insert(room.name);
    for (const std::string& used : room.uses) {
      REQUIRE_MESSAGE((allowed.contains(used) && used != room.name), room.name, " stands before ", used);
      mine.insert(allowed[used].begin(), allowed[used].end());
    }
    for (const std::string& header : room.headers) {
      REQUIRE_MESSAGE(allowed.contains(room_of(header)), room.name, " stands before ", header);
      mine.insert(header);
    }
  }
  return allowed;
}

// What is wrong with an include of one file by another; empty: nothing.
std::string find_fault(const Allowed& allowed, const std::string& file, const std::string& header) {
  const std::string from = room_of(file), to = room_of(header);
  if (!allowed.contains(from)) return "'" + from + "' is no room of the table: " + file;
  if (!allowed.contains(to)) return "'" + to + "' is no room of the table: " + file + " includes " + header;
  if (allowed.at(from).contains(to) || allowed.at(from).contains(header)) return {};
  return "'" + from + "' may not include '" + to + "': " + file + " includes " + header;
}

// A file -> the headers of ours that it includes. Those that the build makes are left out.
using Includes = std::map<std::string, std::set<std::string>>;

Includes find_includes() {
  const fs::path root = PATCHLIGHT_SOURCE_DIR;
  const std::regex pattern(R"(^\s*#\s*include\s*\"([^\"]+)\")");
  Includes includes;
  for (const char* folder : {"engine", "dsl", "tools"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".h" && ending != ".cpp") continue;
      std::set<std::string>& headers = includes[fs::relative(entry.path(), root).string()];
      std::ifstream file(entry.path());
      std::smatch match;
      for (std::string line; std::getline(file, line);)
        if (std::regex_search(line, match, pattern)) headers.insert(match[1]);
    }
  return includes;
}

// A module is a header and the source of its name. One that reaches itself, by way of those that are written
// down, or empty.
std::string find_circle(const Includes& modules) {
  std::set<std::string> done;
  std::vector<std::string> path;
  const auto visit = [&](const auto& self, const std::string& module) -> bool {
    if (done.contains(module)) return false;
    const bool back = std::find(path.begin(), path.end(), module) != path.end();
    path.push_back(module);
    if (back) return true;
    if (const auto row = modules.find(module); row != modules.end())
      for (const std::string& next : row->second)
        if (self(self, next)) return true;
    path.pop_back();
    done.insert(module);
    return false;
  };
  std::string circle;
  for (const auto& [module, included] : modules)
    if (visit(visit, module)) {
      for (const std::string& step : path) circle += (circle.empty() ? "" : " -> ") + step;
      return circle;
    }
  return {};
}

}  // namespace

TEST_CASE("rooms: a folder includes what its row names, and what that may include") {
  const Allowed allowed = find_allowed();
  const Includes includes = find_includes();
  CHECK(includes.size() > 250);
  for (const auto& [file, headers] : includes) {
    for (const std::string& header : headers) {
      if (header.ends_with(".inc")) continue;  // the build makes it
      CHECK_MESSAGE(header.find('/') != std::string::npos, file, " includes ", header,
                    ": includes are written from the root of the sources");
      if (fs::exists(fs::path(PATCHLIGHT_SOURCE_DIR) / header))
        CHECK(find_fault(allowed, file, header) == "");
    }
  }
}

TEST_CASE("rooms: a wrong include is told with both rooms") {
  const Allowed allowed = find_allowed();
  CHECK(find_fault(allowed, "engine/light/direct.cpp", "engine/solve/solve.h") ==
        "'engine/light' may not include 'engine/solve': engine/light/direct.cpp includes "
        "engine/solve/solve.h");
  CHECK(find_fault(allowed, "dsl/language/language.h", "dsl/shapes/shapes.h") ==
        "'dsl/language' may not include 'dsl/shapes': dsl/language/language.h includes dsl/shapes/shapes.h");
  CHECK(find_fault(allowed, "dsl/scene/load.cpp", "engine/mesh/cell.h") != "");
  CHECK(find_fault(allowed, "dsl/scene/load.cpp", "engine/film/film.h") != "");
  CHECK(find_fault(allowed, "dsl/scene/load.cpp", "engine/film/lens.h") == "");
  CHECK(find_fault(allowed, "attic/box.h", "dsl/report/text.h").starts_with("'attic' is no room"));
  CHECK(find_fault(allowed, "tools/verbs/view.cpp", "engine/base/vector.h") == "");
}

TEST_CASE("rooms: no header and its source include themselves by way of others") {
  Includes modules;
  const auto module_of = [](const std::string& path) { return path.substr(0, path.rfind('.')); };
  for (const auto& [file, headers] : find_includes())
    for (const std::string& header : headers)
      if (module_of(header) != module_of(file)) modules[module_of(file)].insert(module_of(header));
  CHECK(find_circle(modules) == "");
  CHECK(find_circle({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}) == "a -> b -> c -> b");
  CHECK(find_circle({{"a", {"b", "c"}}, {"b", {"c"}}, {"c", {}}}) == "");
}

TEST_CASE("rooms: each says what comes in, what goes out, and what it may not know") {
  for (const Room& room : kRooms) {
    if (room.name == "engine" || room.name == "tools/compare") continue;  // whose pages say more
    CAPTURE(room.name);
    std::ifstream file(fs::path(PATCHLIGHT_SOURCE_DIR) / room.name / "README.md");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    REQUIRE(lines.size() == 3);
    CHECK(lines[0].starts_with("* In: "));
    CHECK(lines[1].starts_with("* Out: "));
    CHECK(lines[2].starts_with("* May not know: "));
  }
}
