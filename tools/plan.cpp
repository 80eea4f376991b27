// Options over scene -> Plan, and the limits.
#include "plan.h"

#include "animation.h"
#include "dsl/diagnostics.h"
#include "dsl/limits.h"
#include "engine/film/film.h"
#include "engine/solve/forecast.h"
#include "engine/base/parallel.h"
#include "engine/solve/sizes.h"
#include "memory.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

// Measured on rooms: 40 for the film itself and about as much while it is made; twice that for busier views.
constexpr uint64_t kFilmBytesPerPixel = 160;
// Colours, bytes and the compressor's table, of two pictures on their way to a file.
constexpr uint64_t kPictureBytesPerPixel = 64;
// Two pictures with their channels, each as columns of its own, as the library's blocks and as its file.
constexpr uint64_t kLayerBytesPerPixel = 340;
// What is likely: the film itself; the same and pictures in the making; the program with its libraries.
constexpr double kFilmBytesLikely = 44, kPictureBytesLikely = 60, kProgramBytesLikely = 12e6;
constexpr double kPictureSeconds = 0.1e-6;  // a pixel and snapshot: shown and encoded
constexpr double kShareOfThreads = 0.95;    // of their number

template <class Value, class Asked>
void override_with(Value& value, const std::optional<Asked>& asked) {
  if (asked) value = static_cast<Value>(*asked);
}

// What is kept for pictures of several passes: the light of some of them, and frames.
uint64_t forecast_series_bytes(const Scene& scene, const Plan& plan) {
  // Somewhat more corners than patches, a colour each; a film of a round's patches with its lines.
  constexpr uint64_t kLightBytesPerPatch = 15, kRoundsMost = 16;
  const bool parts = plan.look.light != Light::kAll ||
                     std::any_of(plan.exporters.begin(), plan.exporters.end(), [](const Exporter* exporter) {
                       return exporter->pixels == PixelKind::kLayers;
                     });
  const uint64_t kept = (parts ? 1u : 0u) + (plan.storyboard ? 1u : 0u) +
                        (plan.look.false_color == FalseColor::kResidual ? 2u : 0u);
  uint64_t bytes = kept * kLightBytesPerPatch * scene.solver.patch_count_max;
  const uint64_t frames = (plan.animate_passes ? scene.solver.pass_count_max : 0) +
                          (plan.animate_rounds ? kRoundsMost : 0) +
                          (plan.animate_shots ? plan.snapshots.size() : 0);
  for (const Camera& camera : plan.cameras) bytes += frames * count_frame_bytes(camera.width, camera.height);
  return bytes;
}

// Throws UserError (usage) for a look that other solvers do not have: where a step is no bounce of light.
void check_look(const Plan& plan) {
  if (plan.animate_shots && (!plan.solver->chooses_steps || plan.snapshots.front() == kSolutionStep))
    throw UserError("usage", "--animation shots: expected --solver shooting and --shots, such as 1-40");
  if (plan.goes_by_passes()) return;
  std::string flag;
  if (plan.look.light != Light::kAll) flag = "--light";
  if (plan.look.false_color == FalseColor::kResidual) flag = "--false-color residual";
  if (plan.animate_passes) flag = "--animation passes";
  if (!flag.empty())
    throw UserError("usage", fmt::format("{}: expected --solver passes, found {}", flag, plan.solver->name));
}

std::vector<Camera> pick_cameras(const Scene& scene, const Options& options) {
  std::vector<Camera> cameras = scene.cameras;
  if (!options.camera.empty()) {
    std::vector<std::string> names;
    for (const Camera& camera : cameras)
      if (!camera.name.empty()) names.push_back(camera.name);
    std::erase_if(cameras, [&](const Camera& camera) { return camera.name != options.camera; });
    const std::string near = did_you_mean(options.camera, names);
    if (cameras.empty())
      throw UserError("usage",
                      fmt::format("--camera: the scene has no camera '{}'{}", escape_text(options.camera),
                                  names.empty()  ? "; it names none"
                                  : near.empty() ? ""
                                                 : fmt::format("; did you mean '{}'?", near)));
  }
  if (options.size)
    for (Camera& camera : cameras) {
      camera.width = (*options.size)[0];
      camera.height = (*options.size)[1];
    }
  return cameras;
}

// No scene needs so many; a closed room of reflectance 1 never ends.
constexpr uint32_t kShotsMax = 10'000'000;

// The solver, how far it goes, and what is pictured on the way.
void plan_steps(Plan& plan, Scene& scene, const Options& options) {
  plan.solver = &solvers()[0];
  for (const Solver& solver : solvers())
    if (solver.name == options.solver) plan.solver = &solver;
  if (!options.max_patches)
    scene.solver.patch_count_max = std::min(scene.solver.patch_count_max, plan.solver->patch_count_usual);
  if (plan.solver == &solvers()[0]) {
    plan.step_count_max = scene.solver.pass_count_max;
    plan.snapshots =
        pick_snapshots(scene.output.snapshots, options.snapshots_all, scene.solver.pass_count_max);
    return;
  }
  scene.output.ambient = options.ambient;
  plan.snapshots = options.shots.empty() ? std::vector<uint32_t>{kSolutionStep} : options.shots;
  plan.step_count_max = options.shots.empty() ? kShotsMax : options.shots.back();
}

}  // namespace

bool Plan::has_pictures() const {
  return storyboard || animate_passes || animate_shots ||
         std::any_of(exporters.begin(), exporters.end(),
                     [](const Exporter* exporter) { return has_pixels(exporter->pixels); });
}

bool Plan::goes_by_passes() const { return solver->goes_by_bounces; }

bool Plan::is_exposed() const {
  return storyboard || animate_passes || animate_shots ||
         std::any_of(exporters.begin(), exporters.end(), [](const Exporter* exporter) {
           return exporter->pixels == PixelKind::kDisplay || exporter->exposed;
         });
}

bool Plan::records_passes() const {
  return std::any_of(exporters.begin(), exporters.end(),
                     [](const Exporter* exporter) { return exporter->export_passes != nullptr; });
}

bool makes_films(const Plan& plan, const Scene& scene) {
  return plan.has_pictures() || (plan.is_exposed() && !scene.output.exposure_ev);
}

std::vector<uint32_t> pick_snapshots(const std::vector<uint32_t>& asked, bool all, uint32_t pass_count) {
  std::vector<uint32_t> passes;
  if (all) {
    for (uint32_t pass = 1; pass <= pass_count; ++pass) passes.push_back(pass);
  } else if (asked.empty()) {
    for (const uint32_t pass : {1u, 2u, 16u}) passes.push_back(std::min(pass, pass_count));
    passes.erase(std::unique(passes.begin(), passes.end()), passes.end());
  } else {
    passes = asked;
    if (passes.back() > pass_count)
      throw UserError(
          "snapshot-beyond-passes",
          fmt::format("snapshot {} is asked for, but the run has {} passes at most; raise passes or "
                      "ask for earlier snapshots",
                      passes.back(), pass_count));
  }
  return passes;
}

std::string pick_stem(const std::string& scene_file, const std::string& basename) {
  if (!basename.empty()) return basename;
  if (scene_file == "-" || scene_file == "<stdin>") return "scene";
  std::string stem = scene_file.substr(scene_file.rfind('/') + 1);
  for (const std::string_view ending : {".yaml", ".yml"})
    if (stem.size() > ending.size() && stem.ends_with(ending)) {
      stem.resize(stem.size() - ending.size());
      break;
    }
  return stem;
}

Plan make_plan(Scene& scene, const Options& options) {
  override_with(scene.solver.pass_count_max, options.passes);
  override_with(scene.solver.rays, options.rays);
  override_with(scene.solver.quality, options.quality);
  override_with(scene.solver.seed, options.seed);
  override_with(scene.solver.patch_count_max, options.max_patches);
  override_with(scene.output.shading, options.shading);
  if (options.exposure_auto) scene.output.exposure_ev.reset();
  if (options.exposure_ev) scene.output.exposure_ev = options.exposure_ev;
  if (!options.snapshots.empty()) scene.output.snapshots = options.snapshots;

  Plan plan;
  plan.stem = pick_stem(scene.file, scene.output.basename);
  if (plan.stem.empty() || plan.stem.find('/') != std::string::npos)
    throw UserError("output-outside-dir",
                    fmt::format("'{}' cannot begin the names of files", escape_text(plan.stem)));
  plan_steps(plan, scene, options);
  plan.cameras = pick_cameras(scene, options);
  plan.cameras_named = scene.cameras.size() > 1;
  plan.mesh = options.mesh;
  plan.look = options.look;
  plan.storyboard = options.storyboard;
  plan.animate_passes = options.animate_passes;
  plan.animate_rounds = options.animate_rounds;
  plan.animate_shots = options.animate_shots;
  check_look(plan);
  for (const std::string& format : options.formats) plan.exporters.push_back(&find_exporter(format));
  plan.limits = options.load.limits;
  plan.bytes_max = options.max_memory ? *options.max_memory : find_memory_available();
  plan.seconds_max = options.max_seconds;
  plan.thread_count = options.threads ? *options.threads : thread_count_default();
  plan.starting_patches = count_starting_patches(scene.faces, scene.solver);
  scene.solver.keep_rows =
      options.keep_rows ? *options.keep_rows : forecast_run_bytes(scene, plan) <= plan.bytes_max;
  return plan;
}

std::string name_steps(std::string_view step) {
  return fmt::format("{}{}", step, step == "pass" ? "es" : "s");
}

std::string name_camera(const Plan& plan, const Camera& camera) {
  return plan.cameras_named ? plan.stem + "-" + camera.name : plan.stem;
}

std::string make_picture_name(const Plan& plan, const Scene& scene, const Camera& camera, uint32_t step,
                              const Exporter& exporter) {
  const bool display = exporter.pixels == PixelKind::kDisplay, mesh = plan.mesh && display;
  // Of levels and reasons there are flat pictures only, and beside them only flat numbers.
  const bool of_patches = is_of_patches(plan.look.false_color);
  const bool flat = of_patches ? !display : scene.output.shading == Shading::kFlat;
  const auto name = [](bool named, const std::vector<std::string>& names, auto choice) {
    return named ? "-" + names[static_cast<size_t>(choice)] : "";
  };
  const Look& look = plan.look;
  const bool colored = display && look.false_color != FalseColor::kOff;
  const bool lit = !colored || look.false_color == FalseColor::kRadiosity;
  const std::string place = step == kSolutionStep
                                ? "solution"
                                : fmt::format("{}-{:0{}}", plan.solver->step, step, plan.solver->digits);
  return fmt::format("{}-{}{}{}{}{}{}{}.{}", name_camera(plan, camera), place,
                     scene.output.ambient ? "-ambient" : "",
                     name(lit && look.light != Light::kAll, kLightNames, look.light),
                     name(colored, kFalseColorNames, look.false_color),
                     name(display && !colored && look.tone != Tone::kClip, kToneNames, look.tone),
                     flat ? "-flat" : "", mesh ? "-mesh" : "", exporter.format);
}

uint64_t forecast_run_bytes(const Scene& scene, const Plan& plan) {
  uint64_t bytes = forecast_bytes(scene.faces, scene.solver, plan.starting_patches) +
                   plan.solver->forecast_bytes(scene.faces, scene.solver, plan.starting_patches);
  // Files of the whole solution are written one after the other.
  uint64_t bytes_per_patch = 0;
  for (const Exporter* exporter : plan.exporters)
    bytes_per_patch = std::max<uint64_t>(bytes_per_patch, exporter->bytes_per_patch);
  bytes += bytes_per_patch * scene.solver.patch_count_max;
  if (!makes_films(plan, scene)) return bytes;
  uint64_t pixels_largest = 0;
  for (const Camera& camera : plan.cameras) {
    const uint64_t pixels = uint64_t{camera.width} * camera.height;
    pixels_largest = std::max(pixels_largest, pixels);
    bytes += pixels * kFilmBytesPerPixel;
  }
  bytes += pixels_largest * kPictureBytesPerPixel + forecast_series_bytes(scene, plan);
  for (const Exporter* exporter : plan.exporters)
    if (exporter->pixels == PixelKind::kLayers) bytes += pixels_largest * kLayerBytesPerPixel;
  return bytes;
}

RunForecast forecast_run(const Scene& scene, const Plan& plan) {
  const Forecast solve = forecast_solve(scene.faces, scene.solver, plan.starting_patches);
  double bytes = kProgramBytesLikely + solve.bytes, seconds = solve.seconds, pixels_largest = 0;
  bytes += static_cast<double>(plan.solver->forecast_bytes(scene.faces, scene.solver, plan.starting_patches));
  seconds += plan.solver->forecast_seconds(scene.faces, scene.solver, plan.starting_patches);
  if (makes_films(plan, scene))
    for (const Camera& camera : plan.cameras) {
      const double pixels = static_cast<double>(uint64_t{camera.width} * camera.height);
      pixels_largest = std::max(pixels_largest, pixels);
      bytes += pixels * kFilmBytesLikely;
      seconds += forecast_film_seconds(scene.faces, pixels) +
                 pixels * kPictureSeconds * static_cast<double>(plan.snapshots.size());
    }
  bytes += pixels_largest * kPictureBytesLikely;
  const auto threads = static_cast<double>(plan.thread_count);
  return {static_cast<uint64_t>(bytes), seconds / std::max(1.0, threads * kShareOfThreads)};
}

void check_limits(const Scene& scene, const Plan& plan) {
  for (const Camera& camera : plan.cameras) {
    const std::string fault = find_image_fault(plan.limits, camera.width, camera.height);
    if (!fault.empty()) throw UserError("image-too-large", fault, scene.file);
  }
  const uint64_t patches = plan.starting_patches;
  // First what no budget of patches would mend.
  const uint64_t solver_bytes = plan.solver->forecast_bytes(scene.faces, scene.solver, patches);
  if (solver_bytes > plan.bytes_max)
    throw UserError("memory-limit",
                    fmt::format("--solver {} may need {} for {} patches; the limit is {}, what is available "
                                "unless --max-memory says another; take fewer patches or --solver {}",
                                plan.solver->name, format_bytes(solver_bytes),
                                std::max(patches, scene.solver.patch_count_max), format_bytes(plan.bytes_max),
                                solvers()[0].name),
                    scene.file);
  if (patches > scene.solver.patch_count_max)
    throw UserError("too-many-patches",
                    fmt::format("the scene starts with {} patches; the limit is {}; raise max_patches "
                                "(--max-patches) or patch_size",
                                patches, scene.solver.patch_count_max),
                    scene.file);
  const uint64_t bytes = forecast_run_bytes(scene, plan);
  if (bytes > plan.bytes_max)
    throw UserError("memory-limit",
                    fmt::format("the run may need {}; the limit is {}, what is available unless --max-memory "
                                "says another; lower max_patches, rays or size",
                                format_bytes(bytes), format_bytes(plan.bytes_max)),
                    scene.file);
  const double seconds = forecast_run(scene, plan).seconds;
  if (seconds > plan.seconds_max)
    throw UserError(
        "time-limit",
        fmt::format("the run will likely take {}; the limit is {} (--max-seconds raises it); lower "
                    "max_patches, rays or size",
                    format_seconds(seconds), format_seconds(plan.seconds_max)),
        scene.file);
}

std::string format_count(uint64_t count) {
  const double value = static_cast<double>(count);
  if (count >= 1'000'000'000) return fmt::format("{:.3g} billion", value * 1e-9);
  if (count >= 1'000'000) return fmt::format("{:.3g} million", value * 1e-6);
  return fmt::format("{}", count);
}

std::string format_bytes(uint64_t bytes) {
  const double value = static_cast<double>(bytes);
  if (value >= 1e9) return fmt::format("{:.1f} GB", value * 1e-9);
  return fmt::format("{:.1f} MB", value * 1e-6);
}

std::string format_seconds(double seconds) {
  constexpr double kMinute = 60, kHour = 3600, kDay = 86'400;
  if (seconds >= 2 * kDay) return fmt::format("{:.3g} days", seconds / kDay);
  if (seconds >= 2 * kHour) return fmt::format("{:.3g} hours", seconds / kHour);
  if (seconds >= 2 * kMinute) return fmt::format("{:.3g} minutes", seconds / kMinute);
  return fmt::format("{:.2g} s", seconds);
}

std::string format_watts(double watts) {
  if (watts >= 1e6) return fmt::format("{:.3g} MW", watts * 1e-6);
  if (watts >= 1e3) return fmt::format("{:.3g} kW", watts * 1e-3);
  if (watts >= 1 || watts <= 0) return fmt::format("{:.3g} W", watts);
  return fmt::format("{:.3g} mW", watts * 1e3);
}

}  // namespace patchlight
