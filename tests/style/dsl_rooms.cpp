// The rooms of dsl as a test: a table of who may include whom, and no circle among their modules.
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

// A room and those that it may include, but for itself.
struct Room {
  std::string name;
  std::vector<std::string> below;
};

const std::vector<Room> kRooms = {
    {"report", {}},
    {"yaml", {"report"}},
    {"language", {"report", "yaml"}},
    {"polygons", {"report", "yaml"}},
    {"models", {"report", "yaml", "language", "polygons"}},
    {"shapes", {"report", "yaml", "language", "polygons", "models"}},
    {"scene", {"report", "yaml", "language", "polygons", "models", "shapes"}},
};

// A module is a header and the source of its name: "language/values". Includes of dsl's own headers only.
using Modules = std::map<std::string, std::set<std::string>>;

std::string module_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

Modules find_modules() {
  const fs::path root = fs::path(PATCHLIGHT_SOURCE_DIR) / "dsl";
  const std::regex pattern(R"(^\s*#\s*include\s*"dsl/([^"]+)\")");
  Modules modules;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    const std::string module = module_of(fs::relative(entry.path(), root).string());
    std::set<std::string>& included = modules[module];
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);)
      if (std::regex_search(line, match, pattern) && module_of(match[1]) != module)
        included.insert(module_of(match[1]));
  }
  return modules;
}

std::string room_of(const std::string& module) { return module.substr(0, module.find('/')); }

// What is wrong with an include of a module by another; empty: nothing.
std::string find_fault(const std::string& from, const std::string& to) {
  const std::string room = room_of(from), other = room_of(to);
  const auto row = std::find_if(kRooms.begin(), kRooms.end(), [&](const Room& r) { return r.name == room; });
  if (row == kRooms.end()) return "'" + room + "' is no room of the table";
  if (room == other || std::find(row->below.begin(), row->below.end(), other) != row->below.end()) return {};
  return "'" + room + "' may not include '" + other + "': " + from + " includes " + to;
}

// A module that reaches itself, by way of those that are written down, or empty.
std::string find_circle(const Modules& modules) {
  std::set<std::string> done;
  std::vector<std::string> path;
  std::string circle;
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
  for (const auto& [module, included] : modules)
    if (visit(visit, module)) {
      for (const std::string& step : path) circle += (circle.empty() ? "" : " -> ") + step;
      return circle;
    }
  return {};
}

}  // namespace

TEST_CASE("dsl's rooms include downwards only") {
  const Modules modules = find_modules();
  CHECK(modules.size() > 60);
  for (const auto& [module, included] : modules)
    for (const std::string& other : included) CHECK(find_fault(module, other) == "");
  for (size_t k = 0; k < kRooms.size(); ++k)
    for (const std::string& below : kRooms[k].below)
      CHECK(std::any_of(kRooms.begin(), kRooms.begin() + static_cast<ptrdiff_t>(k),
                        [&](const Room& r) { return r.name == below; }));
}

TEST_CASE("a wrong include is told with both rooms") {
  CHECK(find_fault("language/language", "shapes/shapes") ==
        "'language' may not include 'shapes': language/language includes shapes/shapes");
  CHECK(
      find_fault("polygons/flatten", "language/number").starts_with("'polygons' may not include 'language'"));
  CHECK(find_fault("attic/box", "report/text") == "'attic' is no room of the table");
  CHECK(find_fault("scene/load", "report/text") == "");
}

TEST_CASE("no module of dsl includes itself by way of others") {
  CHECK(find_circle(find_modules()) == "");
  CHECK(find_circle({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}) == "a -> b -> c -> b");
  CHECK(find_circle({{"a", {"b", "c"}}, {"b", {"c"}}, {"c", {}}}) == "");
}

TEST_CASE("every room of dsl says what comes in, what goes out, and what it may not know") {
  for (const Room& room : kRooms) {
    CAPTURE(room.name);
    std::ifstream file(fs::path(PATCHLIGHT_SOURCE_DIR) / "dsl" / room.name / "README.md");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    REQUIRE(lines.size() == 3);
    CHECK(lines[0].starts_with("* In: "));
    CHECK(lines[1].starts_with("* Out: "));
    CHECK(lines[2].starts_with("* May not know: "));
  }
}
