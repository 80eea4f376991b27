// The files that render writes: one row a kind, one file export_NAME.cpp a row.
#pragma once

#include "dsl/scene/scene.h"
#include "tools/base/files.h"
#include "tools/export/pass_record.h"
#include "tools/export/run_report.h"
#include "tools/image/animation.h"
#include "tools/image/picture.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

// A run at its end, for files of the whole of it.
struct FinishedRun {
  const Scene& scene;
  const Solution& solution;
  const PassRecord& record;  // of passes, where a row asks for it
  const RunReport& report;
  std::string_view stem;  // S in the names of files
};

// A format may have several rows: then it is several files.
struct Exporter {
  std::string_view format;  // its name on the command line and the end of its files' names
  // One of these three: a picture after each asked step, as the file's bytes; frames, which --animation asks
  // for; a file of the finished run.
  std::string (*encode_picture)(const Picture&) = nullptr;
  std::string (*encode_animation)(const Animation&) = nullptr;
  void (*export_run)(NewFile&, const FinishedRun&) = nullptr;
  // It shows light as a display does, by the run's exposure: such pictures hold 0..1, with lines and legends.
  // Others hold mean radiosity, W/m2, without limit.
  bool exposed = false;
  // Of pictures: they have channels of their parts and of what is seen, too; what writing them holds beside
  // the picture.
  bool layers = false;
  uint32_t bytes_per_pixel = 0;
  // Of a finished run: what its file's name has after S, before the dot; whether it shows all recorded
  // passes; whether it is written of every run, whatever --format says (one row is); what writing it holds at
  // most.
  std::string_view name_end = "";
  bool records = false;
  bool always = false;
  uint32_t bytes_per_patch = 0;
};

std::span<const Exporter> exporters();
// What --format knows, each once.
std::vector<std::string> exporter_formats();
// The first row of a known format.
const Exporter& find_exporter(std::string_view format);
// The row that is written of every run.
const Exporter& find_report();

// S-patches.csv, S.glb and the like: the name of a finished run's file.
std::string name_run_file(std::string_view stem, const Exporter& exporter);

}  // namespace patchlight
