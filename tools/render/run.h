// What the files of the verb render share: all that a run gathers.
#pragma once

#include "engine/film.h"
#include "tools/base/files.h"
#include "tools/base/talk.h"
#include "tools/export/exporters.h"
#include "tools/export/pass_record.h"
#include "tools/export/run_report.h"
#include "tools/image/animation.h"
#include "tools/image/false_colors.h"
#include "tools/image/light_parts.h"
#include "tools/image/storyboard.h"
#include "tools/render/plan.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace patchlight {

class LapWatch {
 public:
  // Seconds since it was made or last asked.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// What is gathered for pictures of the whole run; a row a camera.
struct Series {
  std::vector<Storyboard> storyboards;
  std::vector<Animation> passes, rounds, shots;
  ColorScale added_scale;  // of the storyboards
  std::vector<Rgb> told;   // radiosity as the last panel tells it, W/m2; emission before the first
  uint32_t told_pass = 0;
  std::optional<double> round_ev;
};

struct Run {
  Talk& talk;
  Scene scene;
  Plan plan;
  std::string folder;
  Solution solution;
  std::vector<FilmTable> films;      // a row a camera, once made
  std::vector<CentreTable> centres;  // a row a camera, where a format wants them
  PassRecord record;                 // of passes so far, where a format asks for it
  LightHistory light;
  ColorScale scale;  // of false colours
  Series series;
  RunReport report;
  std::vector<std::string> tables, pictures;  // paths of files, written or on their way
  JobQueue jobs;
  explicit Run(Talk& talk_of_program) : talk(talk_of_program) {}
};

}  // namespace patchlight
