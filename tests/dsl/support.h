// What the tests of the loader share: scenes to build on, and short ways to load and to ask.
#pragma once

#include "dsl/scene/load.h"

#include <string>
#include <string_view>
#include <vector>

namespace patchlight::test {

inline const std::string kHead =
    "patchlight: 1\nmaterials:\n  white: {reflectance: [0.73, 0.73, 0.73]}\n"
    "  lamp: {reflectance: 0.0, emission: [15, 15, 12]}\nobjects:\n";
inline const std::string kFloor =
    "  - {id: floor, polygon: [[0,0,0],[0,0,1],[1,0,1],[1,0,0]], material: white, subdivide: 4}\n";
inline const std::string kLight =
    "  - {id: light, polygon: [[0,1,0],[1,1,0],[1,1,1],[0,1,1]], material: lamp}\n";
inline const std::string kBase = kHead + kFloor + kLight;

// What loading a text says: the scene, or the errors, and the warnings.
struct Loaded {
  Scene scene;
  std::vector<Diagnostic> errors, warnings;
  size_t more = 0;
};

inline Loaded load(const std::string& text, const Limits& limits = {}) {
  Loaded loaded;
  try {
    loaded.scene = load_scene_text(text, "t.yaml", loaded.warnings, {{}, {}, limits});
  } catch (const UserError& error) {
    loaded.errors = error.diagnostics;
    loaded.more = error.more;
  }
  return loaded;
}

inline std::string repeat_text(std::string_view text, size_t count) {
  std::string all;
  for (size_t k = 0; k < count; ++k) all += text;
  return all;
}

inline size_t count_slug(const std::vector<Diagnostic>& list, std::string_view slug) {
  size_t count = 0;
  for (const Diagnostic& row : list) count += row.slug == slug;
  return count;
}

// A face's corner in the file's own units.
inline DVec3 corner_in_file(const Scene& scene, size_t face, size_t corner) {
  return DVec3(scene.faces.corners[face][corner]) * scene.units_per_length + scene.origin;
}

inline double face_area(const Scene& scene, size_t face) {
  const auto c = [&](size_t k) { return corner_in_file(scene, face, k); };
  const DVec3 sum = glm::cross(c(1) - c(0), c(2) - c(0)) + glm::cross(c(2) - c(0), c(3) - c(0));
  return glm::length(sum) / 2;
}

}  // namespace patchlight::test
