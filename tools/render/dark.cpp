// Runs whose pictures are dark to the reasons.
#include "tools/render/dark.h"

#include "engine/solve/dark.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

// Lamps by the entry of the list `objects` that they are, or stand in: a box that shines into a room with one
// of its sides alone is right.
struct Lamp {
  uint32_t polygon = kNone;  // the first that emits; kNone: none does
  bool reaches = false;
};

std::vector<Lamp> list_lamps(const Scene& scene, const Solution& solution) {
  std::vector<Lamp> lamps(scene.object_ids.size());
  const std::vector<uint8_t> reaching = find_reaching(solution);
  const FaceTable& faces = scene.faces;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    if (largest(faces.emission[f]) <= 0) continue;
    const uint32_t polygon = faces.polygon[f];
    Lamp& lamp = lamps[scene.polygons.object[polygon]];
    lamp.polygon = std::min(lamp.polygon, polygon);
    lamp.reaches |= reaching[polygon] != 0;
  }
  std::erase_if(lamps, [](const Lamp& lamp) { return lamp.polygon == kNone; });
  return lamps;
}

void warn_of_lamps(const Scene& scene, const Solution& solution, Talk& talk) {
  // Where nothing emits, or heat alone is asked for, that was said, or is meant.
  const std::vector<Lamp> lamps = list_lamps(scene, solution);
  if (scene.is_heat || lamps.empty()) return;
  const auto lost = static_cast<size_t>(
      std::count_if(lamps.begin(), lamps.end(), [](const Lamp& lamp) { return !lamp.reaches; }));
  if (lost == lamps.size())
    return say_warning(talk, "nothing-lit",
                       "no surface receives light: what the lamps send meets back sides or leaves the scene; "
                       "look which way lamps and surfaces face",
                       scene.file);
  if (!reflects_light(scene.faces))
    return say_warning(talk, "nothing-lit",
                       "no surface reflects light: pictures show lamps alone; give a material a reflectance",
                       scene.file);
  for (const Lamp& lamp : lamps)
    if (!lamp.reaches)
      say_warning(
          talk, "lost-lamp",
          fmt::format("the light of '{}' reaches no surface: it meets back sides or leaves the scene; "
                      "look which way it faces, and whether it stands inside of a solid",
                      scene.polygons.id[lamp.polygon]),
          scene.file);
}

}  // namespace

void warn_of_dark(const Task& task, const PictureState& pictures, const Solution& solution, Talk& talk) {
  if (solution.log.passes.empty()) return;
  warn_of_lamps(task.scene, solution, talk);
  for (size_t k = 0; k < pictures.films.size(); ++k) {
    if (!pictures.films[k].value.empty()) continue;
    const std::string& name = task.plan.cameras[k].name;
    say_warning(
        talk, "empty-view",
        fmt::format("{} has no surface in view, or sees back sides alone: its pictures are black; turn "
                    "its target or move its eye",
                    name.empty() ? "the camera" : fmt::format("the camera '{}'", name)),
        task.scene.file);
  }
}

}  // namespace patchlight
