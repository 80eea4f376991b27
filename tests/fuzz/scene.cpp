// Fuzz target: any bytes as a scene. It loads, or is refused with a message; nothing else.
#include "dsl/scene/load.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

using namespace patchlight;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_message(const Diagnostic& message) {
  require(!message.slug.empty() && !message.message.empty());
  for (const char c : format_diagnostic(message))
    require((static_cast<uint8_t>(c) >= 0x20 && c != 0x7f) || c == '\n');
}

// Limits that keep a run within milliseconds: others are found as well by small scenes.
LoadOptions small_options() {
  LoadOptions options;
  options.limits.polygons = 500;
  options.limits.corners = 500;
  options.limits.values = 20'000;
  options.limits.alias_values = 5'000;
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const LoadOptions options = small_options();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::vector<Diagnostic> warnings;
  try {
    // A folder that is not there: what the text includes is never found.
    const Scene scene = load_scene_text(text, "/nonexistent/fuzz.yaml", warnings, options);
    require(scene.faces.size() > 0 && scene.polygons.face_first.back() == scene.faces.size());
    require(!scene.cameras.empty());
    for (const auto& corners : scene.faces.corners)
      for (const Vec3& p : corners) require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  } catch (const UserError& error) {
    require(!error.diagnostics.empty() && exit_code(error.diagnostics.front()) >= 2);
    for (const Diagnostic& message : error.diagnostics) check_message(message);
  }
  for (const Diagnostic& message : warnings) check_message(message);
  return 0;
}
