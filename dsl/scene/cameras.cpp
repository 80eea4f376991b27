// Cameras: their keys, and maps to rows.
#include "dsl/scene/cameras.h"

#include "dsl/language/values.h"
#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_set>

namespace patchlight {
namespace {

using enum ValueType;

constexpr double kSineMin = 1e-6;  // between view direction and up: less is parallel

constexpr KeyRow kRows[] = {
    {"name", kName, false, "", 0, 0, "bad-name", "",
     "Name, part of the picture's file name. Required where there are several."},
    {"eye", kVec3, true, "", -kCoordinateMax, kCoordinateMax, "coordinate-too-large", "",
     "Where the camera stands."},
    {"target", kVec3, true, "", -kCoordinateMax, kCoordinateMax, "coordinate-too-large", "",
     "The point that it looks at."},
    {"up", kVec3, false, "0 1 0", -kAnyNumber, kAnyNumber, "out-of-range", "", "What is up in the picture."},
    {"fov", kNumber, false, "60", 0.01, 175, "out-of-range", "",
     "Vertical field of view, degrees; a fisheye has a fixed one."},
    {"size", kIntegers2, false, "960 720", 1, kAnyInteger, "out-of-range", "",
     "Width and height of the picture, pixels."},
};

// The choices of `projection` are the rows of projections.cpp; the first is the usual one.
std::vector<KeyRow> join_rows() {
  static std::string names;
  for (const Projection& projection : projections())
    names += (names.empty() ? "" : "|") + std::string(projection.name);
  std::vector<KeyRow> rows(std::begin(kRows), std::end(kRows));
  rows.push_back({"projection", kChoice, false, projections()[0].name, 0, 0, "bad-name", names,
                  "How directions are laid out on the picture."});
  return rows;
}

void report(const Context& context, uint32_t node, std::string_view slug, std::string message) {
  add_error(context.messages, place_of(context.tree, node), slug, std::move(message));
}

// A unit vector without overflow or underflow on the way; zero stays zero.
DVec3 safe_normalize(DVec3 v) {
  const double largest_part = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest_part > 0 ? glm::normalize(v / largest_part) : DVec3(0);
}

bool check_camera(const Context& context, const MapValues& map, const Camera& camera) {
  const DVec3 view = safe_normalize(camera.target - camera.eye), up = safe_normalize(camera.up);
  if (view == DVec3(0)) {
    report(context, map.node, "degenerate-camera",
           "eye and target are the same point: the camera looks nowhere");
    return false;
  }
  if (glm::length(glm::cross(view, up)) < kSineMin) {
    const uint32_t node = has(map, "up") ? value_of(map, "up").node : map.node;
    report(context, node, "degenerate-camera",
           up == DVec3(0) ? "'up' has no length"
                          : "'up' is parallel to the view direction; choose another, e.g. [0, 0, 1]");
    return false;
  }
  const int64_t* size = value_of(map, "size").integer;
  const std::string fault = find_image_fault(context.messages.limits, static_cast<uint64_t>(size[0]),
                                             static_cast<uint64_t>(size[1]));
  if (!fault.empty()) {
    report(context, value_of(map, "size").node, "image-too-large", fault);
    return false;
  }
  return true;
}

}  // namespace

const KeyTable& camera_keys() {
  static const std::vector<KeyRow> rows = join_rows();
  static const KeyTable table = {"camera", rows};
  return table;
}

void read_camera(const Context& context, uint32_t node, std::vector<Camera>& cameras) {
  const MapValues map = read_map(context, node, camera_keys());
  if (!map.good) return;
  Camera camera;
  if (has(map, "name")) camera.name = text_of(context.tree, value_of(map, "name").node);
  camera.eye = vec3_of(value_of(map, "eye"));
  camera.target = vec3_of(value_of(map, "target"));
  camera.up = vec3_of(value_of(map, "up"));
  camera.fov_degrees = value_of(map, "fov").number[0];
  camera.projection = &projections()[static_cast<size_t>(value_of(map, "projection").integer[0])];
  if (!check_camera(context, map, camera)) return;
  camera.width = static_cast<uint32_t>(value_of(map, "size").integer[0]);
  camera.height = static_cast<uint32_t>(value_of(map, "size").integer[1]);
  cameras.push_back(std::move(camera));
}

void read_cameras(const Context& context, uint32_t list, std::vector<Camera>& cameras) {
  const bool several = context.tree.nodes[list].count > 1;
  std::unordered_set<std::string> names;
  for (uint32_t child = context.tree.nodes[list].first; child != kNone;
       child = context.tree.nodes[child].next) {
    const size_t before = cameras.size();
    read_camera(context, child, cameras);
    if (cameras.size() == before) continue;
    const std::string& name = cameras.back().name;
    if (name.empty() && several)
      report(context, child, "missing-key", "where there are several cameras, each needs a name");
    if (!name.empty() && !names.insert(name).second)
      report(context, child, "duplicate-id", fmt::format("two cameras are called '{}'", name));
  }
}

}  // namespace patchlight
