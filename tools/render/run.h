// What the stages of the verb render hand to each other. A stage takes what it only reads as const, and what
// it makes or adds to by reference; nothing else passes between them.
#pragma once

#include "engine/base/stopwatch.h"
#include "engine/film/film.h"
#include "tools/base/files.h"
#include "tools/export/run_report.h"
#include "tools/image/animation.h"
#include "tools/image/color_scale.h"
#include "tools/image/light_parts.h"
#include "tools/image/storyboard.h"
#include "tools/render/plan.h"

#include <optional>
#include <string>
#include <vector>

namespace patchlight {

// What is to be done; fixed before the first ray.
struct Task {
  const Scene& scene;
  const Plan& plan;
};

// What pictures need beside the solution; fixed once the mesh is, but for the light.
struct PictureState {
  std::vector<FilmTable> films;       // a row a camera
  std::vector<CentreTable> centres;   // a row a camera, where a format wants them
  std::optional<double> exposure_ev;  // where something shows light as a display does
  ColorScale scale;                   // of false colours
  ColorScale added_scale;             // of storyboards
  LightHistory light;
  uint64_t ray_count = 0, bytes = 0;  // of films and centres
};

// What is gathered for pictures of the whole run; a row a camera.
struct Series {
  std::vector<Storyboard> storyboards;
  std::vector<Animation> passes, rounds, shots;
  std::vector<Rgb> told;  // radiosity as the last panel tells it, W/m2; emission before the first
  uint32_t told_pass = 0;
  std::optional<double> round_ev;
  uint64_t ray_count = 0;
};

// Files, written or on their way.
struct OutputFiles {
  std::string folder;
  std::vector<std::string> tables, pictures;  // paths
  JobQueue jobs;
};

// Adds the seconds that it lives to a stage's.
class StageTimer {
 public:
  explicit StageTimer(double& seconds) : seconds_(seconds) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer() { seconds_ += watch_.lap(); }

 private:
  double& seconds_;
  Stopwatch watch_;
};

}  // namespace patchlight
