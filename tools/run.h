// What the files of the verb render share: all that a run gathers.
#pragma once

#include "animation.h"
#include "engine/film/film.h"
#include "engine/base/stopwatch.h"
#include "export_report.h"
#include "false_color.h"
#include "files.h"
#include "light_parts.h"
#include "pass_record.h"
#include "storyboard.h"
#include "talk.h"

#include <optional>
#include <string>
#include <vector>

namespace patchlight {

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
