// What the user asked for on the command line, before the scene is known. Empty optionals: the scene decides.
#pragma once

#include "dsl/scene/load.h"
#include "look.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

// kPrinted: help, versions, a schema ...: `text` holds what is to be printed.
enum class Verb { kRender, kView, kCheck, kVerify, kShow, kFactors, kBench, kPrinted };
enum class ColorChoice { kAuto, kAlways, kNever };

constexpr uint32_t kThreadsMax = 1024;
constexpr uint32_t kPassesFlagMax = 1'000'000;  // a scene file may ask for kPassesMax only

struct BenchOptions {
  std::vector<std::string> scenes;  // paths; empty: those in scenes/
  std::vector<std::string> sections = {"kernels", "scenes"};
  std::string json;  // a file for the result; empty: none
  size_t repetitions = 5;
  double seconds = 0.2;                 // a repetition of a kernel takes at least so long
  size_t threads = 0;                   // 0: all cores
  uint64_t max_patches = ~uint64_t{0};  // no measured mesh has more
  uint64_t max_memory = ~uint64_t{0};   // bytes: growth stops before
};

enum class FactorFormat { kCsv, kJson };

struct FactorOptions {
  FactorFormat format = FactorFormat::kCsv;
  double error = 1e-3;  // of each factor, three standard errors
};

// What a patch sees: from where, and when.
struct ViewOptions {
  std::string polygon;
  double u = 0.5, v = 0.5;
  bool pass_asked = false;
  uint32_t pass = 0;    // 0: emission alone; the last one unless asked
  uint32_t size = 720;  // pixels, either way
  bool label = false;
};

struct Options {
  Verb verb = Verb::kPrinted;
  std::string text;
  std::string scene;  // a path, or - for standard input
  LoadOptions load;   // -D and --set
  std::string out = "out";
  std::optional<uint32_t> passes;
  std::vector<uint32_t> snapshots;  // ascending, no repeats; empty: not asked
  bool snapshots_all = false;
  std::string solver;           // a row of solvers(); empty: the first
  std::vector<uint32_t> shots;  // shooting: pictures after these, ascending; empty: its end
  bool ambient = false;         // shooting
  std::string camera;
  std::optional<std::array<uint32_t, 2>> size;  // width, height, pixels
  std::optional<Shading> shading;
  bool mesh = false;
  Look look;
  bool storyboard = false, animate_passes = false, animate_rounds = false, animate_shots = false;
  bool exposure_auto = false;  // asked for by name: stronger than an EV in the scene
  std::optional<double> exposure_ev;
  std::optional<uint32_t> rays;
  std::optional<double> quality;
  std::optional<uint32_t> threads;
  std::optional<uint64_t> seed;
  std::optional<uint64_t> max_patches;
  std::optional<uint64_t> max_memory;  // bytes; empty: what is available
  double max_seconds = 86'400;         // that the run will likely take
  std::optional<bool> keep_rows;       // form factors cached or computed again; empty: as memory allows
  std::vector<std::string> formats = {"png"};
  std::string report;  // empty: beside the pictures
  bool require_convergence = false;
  bool effective = false;  // show: the merged settings
  std::string shell;       // completion: which
  bool quiet = false;
  bool json = false;
  ColorChoice color = ColorChoice::kAuto;
  FactorOptions factors;
  ViewOptions view;
  BenchOptions bench;
};

}  // namespace patchlight
