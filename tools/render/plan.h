// Scene file and flags -> what this run will do, and whether it may.
#pragma once

#include "engine/solve/solvers.h"
#include "tools/base/options.h"
#include "tools/export/exporters.h"

#include <string>
#include <vector>

namespace patchlight {

// In place of a step's number: where the solver ends, whichever step that is.
constexpr uint32_t kLastStep = ~uint32_t{0};

struct Plan {
  std::string stem;  // S in the names of files
  const Solver* solver = nullptr;
  uint32_t step_count_max = 0;      // steps (passes, shots) at most
  std::vector<uint32_t> snapshots;  // steps to picture: ascending, not empty
  std::vector<Camera> cameras;      // the asked ones, with the asked size
  bool cameras_named = false;       // the scene has several: names of files hold the camera's
  bool mesh = false;
  Look look;
  bool storyboard = false, animate_passes = false, animate_rounds = false, animate_shots = false;
  std::vector<const Exporter*> exporters;
  Limits limits;
  uint64_t bytes_max = 0;   // what the run may hold at its peak
  double seconds_max = 0;   // what it may likely take
  size_t thread_count = 1;  // what it will run on
  uint64_t starting_patches = 0;
  bool has_pictures() const;
  bool is_exposed() const;      // something that it writes shows light as a display does
  bool shows_displays() const;  // pictures of its snapshots are among that
  bool has_layers() const;      // pictures of its snapshots are told in parts
  bool records_passes() const;  // something that it writes shows all passes
  bool shows_passes() const;    // pictures show what single passes add
};

// Writes the flags into scene.solver and scene.output (flags are stronger than the file) and picks the rest.
// Throws UserError: usage for a camera that the scene does not have; snapshot-beyond-passes;
// output-outside-dir.
Plan make_plan(Scene& scene, const Options& options);

// The passes to picture, of a run of `pass_count`. `asked` is empty where nobody named any: then 1, 2 and 16,
// none later than the last pass. Throws UserError (snapshot-beyond-passes).
std::vector<uint32_t> pick_snapshots(const std::vector<uint32_t>& asked, bool all, uint32_t pass_count);

// The scene file's name without its folder and .yaml; "scene" for standard input.
std::string pick_stem(const std::string& scene_file, const std::string& basename);

// S, or S-CAMERA where the scene has several.
std::string name_camera(const Plan& plan, const Camera& camera);

// S-pass-02-direct-flat-mesh.png, S-shot-000100-ambient.png, S-solution.png and the like.
std::string make_picture_name(const Plan& plan, const Scene& scene, const Camera& camera, uint32_t step,
                              const Exporter& exporter);

// True where the run looks through its cameras: for pictures, or to find an exposure by.
bool makes_films(const Plan& plan, const Scene& scene);

// What the run will take, from its first ray to its last file.
struct RunForecast {
  uint64_t bytes_most = 0;  // what it may hold at its peak, an upper estimate
  uint64_t bytes = 0;       // what it will likely hold
  double seconds = 0;       // what it will likely take on the plan's threads, on a core of 2020
};
RunForecast forecast_run(const Scene& scene, const Plan& plan);

// Throws UserError: image-too-large, too-many-patches, memory-limit, time-limit, each with the number found,
// the limit and its flag.
void check_limits(const Scene& scene, const Plan& plan);

}  // namespace patchlight
