// A scene's faces and first camera as JSON on standard output, for programs that render the same scene by
// other means. Points are in engine lengths, emission is radiosity (W/m2), reflectance 0..1; two_sided faces
// stand for both sides.
#include "dsl/scene/load.h"
#include "tools/base/json.h"

#include <fmt/format.h>

#include <cstdio>

namespace patchlight {
namespace {

template <typename Vector>
nlohmann::json triple(const Vector& v) {
  return {v.x, v.y, v.z};
}

nlohmann::json make_export(const Scene& scene) {
  nlohmann::json faces = nlohmann::json::array();
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    // A ray tracer must not choose between two faces on one place: one of the two goes out.
    // Of sides of two materials both do, a hair apart.
    const uint32_t twin = scene.faces.twin[f];
    const bool alike = twin != kNone && scene.faces.emission[f] == scene.faces.emission[twin] &&
                       scene.faces.reflectance[f] == scene.faces.reflectance[twin];
    if (alike && twin < f) continue;
    const Vec3 shift = twin != kNone && !alike ? 1e-5f * scene.faces.normal[f] : Vec3(0);
    nlohmann::json corners = nlohmann::json::array();
    for (size_t k = 0; k < scene.faces.corner_count[f]; ++k)
      corners.push_back(triple(scene.faces.corners[f][k] + shift));
    faces.push_back({{"corners", corners},
                     {"emission", triple(scene.faces.emission[f])},
                     {"reflectance", triple(scene.faces.reflectance[f])},
                     {"two_sided", alike}});
  }
  const Camera& camera = scene.cameras.front();
  return {{"faces", faces},
          {"camera",
           {{"eye", triple(camera.eye)},
            {"target", triple(camera.target)},
            {"up", triple(camera.up)},
            {"fov", camera.fov_degrees}}}};
}

}  // namespace
}  // namespace patchlight

int main(int argc, char** argv) {
  using namespace patchlight;
  if (argc != 2) {
    fmt::print(stderr, "usage: export_faces SCENE.yaml > FACES.json\n");
    return 2;
  }
  try {
    std::vector<Diagnostic> warnings;
    fmt::print("{}\n", make_export(load_scene(argv[1], warnings)).dump());
  } catch (const UserError& error) {
    for (const Diagnostic& diagnostic : error.diagnostics)
      fmt::print(stderr, "{}", format_diagnostic(diagnostic));
    return exit_code(error.diagnostics.front().slug);
  }
  return 0;
}
