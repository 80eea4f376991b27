// What the user asked for on the command line, before the scene is known. Empty optionals: the scene decides.
#pragma once

#include "dsl/scene/load.h"
#include "engine/solve/solvers.h"
#include "tools/base/look.h"

#include <any>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace patchlight {

enum class ColorChoice { kAuto, kAlways, kNever };

constexpr uint32_t kThreadsMax = 1024;
constexpr uint32_t kPassesFlagMax = 1'000'000;  // a scene file may ask for kPassesMax only

struct Options {
  std::string scene;  // a path, or - for standard input
  LoadOptions load;   // -D and --set
  std::string out = "out";
  std::optional<uint32_t> passes;
  std::vector<uint32_t> snapshots;  // ascending, no repeats; empty: not asked
  bool snapshots_all = false;
  const Solver* solver = &solvers()[0];
  std::vector<uint32_t> shots;  // solvers with many steps: pictures after these, ascending; empty: the end
  bool ambient = false;         // solvers that leave light unshot: pictures show a guess of it, too
  std::string camera;
  std::optional<std::array<uint32_t, 2>> size;  // width, height, pixels
  std::optional<Shading> shading;
  bool mesh = false;
  Look look;
  bool storyboard = false, animate_passes = false, animate_rounds = false, animate_shots = false;
  bool exposure_auto = false;  // asked for by name: stronger than an EV in the scene
  std::optional<double> exposure_ev;
  std::optional<uint32_t> rays;
  std::optional<double> error;
  std::optional<double> quality;
  std::optional<uint32_t> threads;
  std::optional<uint64_t> seed;
  std::optional<uint64_t> max_patches;
  std::optional<uint64_t> max_memory;  // bytes; empty: what is available
  double max_seconds = 86'400;         // that the run will likely take
  std::optional<bool> keep_rows;       // form factors cached or computed again; empty: as memory allows
  std::vector<std::string> formats = {"png"};
  bool quiet = false;
  bool json = false;
  ColorChoice color = ColorChoice::kAuto;
  std::any own;  // what a verb alone asks for: a struct in the verb's header
};

// The verb's own options; they must be there.
template <class Own>
const Own& get_own(const Options& options) {
  return *std::any_cast<Own>(&options.own);
}

}  // namespace patchlight
