// What the user asked for on the command line, before the scene is known. Empty optionals: the scene decides.
#pragma once

#include "dsl/load.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

enum class Verb {
  kRender,
  kCheck,
  kFactors,
  kBench,
  kPrinted
};  // kPrinted: help or versions, `text` holds them
enum class ColorChoice { kAuto, kAlways, kNever };

constexpr uint32_t kThreadsMax = 1024;

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
  double error = 1e-3;                 // of each factor, three standard errors
  uint64_t max_memory = ~uint64_t{0};  // bytes
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
  std::string camera;
  std::optional<std::array<uint32_t, 2>> size;  // width, height, pixels
  std::optional<Shading> shading;
  bool mesh = false;
  bool exposure_auto = false;  // asked for by name: stronger than an EV in the scene
  std::optional<double> exposure_ev;
  std::optional<uint32_t> rays;
  std::optional<uint32_t> threads;
  std::optional<uint64_t> seed;
  std::optional<uint64_t> max_patches;
  std::vector<std::string> formats = {"png"};
  std::string report;  // empty: beside the pictures
  bool quiet = false;
  bool json = false;
  ColorChoice color = ColorChoice::kAuto;
  FactorOptions factors;
  BenchOptions bench;
};

}  // namespace patchlight
