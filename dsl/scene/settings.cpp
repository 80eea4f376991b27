// Cameras, solver and output.
#include "dsl/scene/settings.h"

#include "dsl/language/values.h"
#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace patchlight {
namespace {

constexpr double kSineMin = 1e-6;  // between view direction and up: less is parallel

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

void read_snapshots(const Context& context, uint32_t list, const SolverSettings& solver,
                    OutputSettings& output) {
  KeyRow row = row_of(kOutputKeys, "snapshots");
  row.type = ValueType::kInteger;
  if (context.tree.nodes[list].count == 0)
    report(context, list, "expected-list", "'snapshots' names one pass at least; take it out for 1, 2, 16");
  for (uint32_t child = context.tree.nodes[list].first; child != kNone;
       child = context.tree.nodes[child].next) {
    Value value;
    if (!read_value(context, child, row, value)) continue;
    const auto pass = static_cast<uint32_t>(value.integer[0]);
    if (pass > solver.pass_count_max)
      report(context, child, "snapshot-beyond-passes",
             fmt::format("a picture of pass {} is asked, but 'passes' is {}", pass, solver.pass_count_max));
    output.snapshots.push_back(pass);
  }
  std::sort(output.snapshots.begin(), output.snapshots.end());
  output.snapshots.erase(std::unique(output.snapshots.begin(), output.snapshots.end()),
                         output.snapshots.end());
}

void read_exposure(const Context& context, uint32_t node, OutputSettings& output) {
  KeyRow row = row_of(kOutputKeys, "exposure");
  row.type = ValueType::kNumber;
  const std::string_view text = text_of(context.tree, node);
  const bool word = !text.empty() && text.find_first_of("0123456789.=$") == std::string_view::npos;
  Value value;
  if (word)
    report(context, node, "expected-number",
           fmt::format("'exposure' is auto or a number; got {}", describe(context.tree, node)));
  else if (read_value(context, node, row, value))
    output.exposure_ev = value.number[0];
}

}  // namespace

void read_camera(const Context& context, uint32_t node, std::vector<Camera>& cameras) {
  const MapValues map = read_map(context, node, kCameraKeys);
  if (!map.good) return;
  Camera camera;
  if (has(map, "name")) camera.name = text_of(context.tree, value_of(map, "name").node);
  camera.eye = vec3_of(value_of(map, "eye"));
  camera.target = vec3_of(value_of(map, "target"));
  camera.up = vec3_of(value_of(map, "up"));
  camera.fov_degrees = value_of(map, "fov").number[0];
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

void read_solver(const Context& context, uint32_t node, SolverSettings& solver) {
  const MapValues map = read_map(context, node, kSolverKeys);
  if (!map.good) return;
  solver.pass_count_max = static_cast<uint32_t>(value_of(map, "passes").integer[0]);
  solver.until = value_of(map, "until").number[0];
  solver.threshold = static_cast<float>(value_of(map, "threshold").number[0]);
  solver.patch_count_max = static_cast<uint64_t>(value_of(map, "max_patches").integer[0]);
  solver.rays = static_cast<uint32_t>(value_of(map, "rays").integer[0]);
  solver.quality = static_cast<float>(value_of(map, "quality").number[0]);
  solver.seed = static_cast<uint64_t>(value_of(map, "seed").integer[0]);
  solver.patch_size = to_patch_size(value_of(map, "patch_size").number[0]);
  solver.patch_size_min = to_patch_size(value_of(map, "patch_size_min").number[0]);
}

void read_output(const Context& context, uint32_t node, const SolverSettings& solver,
                 OutputSettings& output) {
  const MapValues map = read_map(context, node, kOutputKeys);
  if (!map.good) return;
  output.shading = value_of(map, "shading").integer[0] == 1 ? Shading::kFlat : Shading::kSmooth;
  if (const uint32_t list = value_of(map, "snapshots").node; list != kNone)
    read_snapshots(context, list, solver, output);
  if (const uint32_t exposure = value_of(map, "exposure").node;
      exposure != kNone && text_of(context.tree, exposure) != "auto") {
    read_exposure(context, exposure, output);
  }
  const uint32_t basename = value_of(map, "basename").node;
  if (basename == kNone || !read_text(context, basename, output.basename)) return;
  const std::string& name = output.basename;
  if (name.empty() || name.size() > 200 || name.starts_with('.') || name.find('/') != std::string::npos ||
      name.find("..") != std::string::npos)
    report(context, basename, "output-outside-dir",
           fmt::format("a file name of 1 to 200 bytes without '/' or '..' that does not begin with '.' is "
                       "expected, got '{}'; the folder comes from -o",
                       escape_text(name)));
}

}  // namespace patchlight
