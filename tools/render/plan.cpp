// Options over scene -> Plan, and the limits.
#include "tools/render/plan.h"

#include "dsl/report/diagnostics.h"
#include "dsl/report/limits.h"
#include "engine/base/parallel.h"
#include "engine/film/film.h"
#include "engine/solve/forecast.h"
#include "engine/solve/sizes.h"
#include "tools/base/format.h"
#include "tools/base/memory.h"
#include "tools/image/animation.h"
#include "tools/image/false_colors.h"
#include "tools/image/tone.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

// What a part of a run holds: likely, and at most.
struct Bytes {
  double likely = 0;
  uint64_t most = 0;
};
// A pixel of a camera. Measured on rooms: 40 for the film itself and about as much while it is made; twice
// that for busier views.
constexpr Bytes kFilmBytes = {44, 160};
// A pixel of the largest picture: two of them on their way to a file, with colours, bytes and the
// compressor's table.
constexpr Bytes kPictureBytes = {60, 64};
constexpr double kProgramBytes = 12e6;      // with its libraries
constexpr double kPictureSeconds = 0.1e-6;  // a pixel and snapshot: shown and encoded
constexpr double kShareOfThreads = 0.95;    // of their number

template <class Test>
bool has_any(const Plan& plan, const Test& test) {
  return std::any_of(plan.exporters.begin(), plan.exporters.end(),
                     [&](const Exporter* row) { return test(*row); });
}

template <class Value, class Asked>
void override_with(Value& value, const std::optional<Asked>& asked) {
  if (asked) value = static_cast<Value>(*asked);
}

// What is kept for pictures of several passes: the light of some of them, and frames.
uint64_t forecast_series_bytes(const Scene& scene, const Plan& plan) {
  // Somewhat more corners than patches, a colour each; a film of a round's patches with its lines.
  constexpr uint64_t kLightBytesPerPatch = 15, kRoundsMost = 16;
  const bool parts = plan.look.light != Light::kAll || plan.has_layers();
  const uint64_t kept = (parts ? 1u : 0u) + (plan.storyboard ? 1u : 0u) + (plan.shows_passes() ? 2u : 0u);
  uint64_t bytes = kept * kLightBytesPerPatch * scene.solver.patch_count_max;
  const uint64_t frames = (plan.animate_passes ? scene.solver.pass_count_max : 0) +
                          (plan.animate_rounds ? kRoundsMost : 0) +
                          (plan.animate_shots ? plan.snapshots.size() : 0);
  for (const Camera& camera : plan.cameras) bytes += frames * count_frame_bytes(camera.width, camera.height);
  return bytes;
}

// Throws UserError (usage) for a look that other solvers do not have: where a step is no bounce of light.
void check_look(const Plan& plan) {
  if (plan.animate_shots && (!plan.solver->chooses_steps || plan.snapshots.front() == kLastStep))
    throw UserError("usage", fmt::format("--animation shots: expected --solver {} and --shots, such as 1-40",
                                         name_solvers(&Solver::chooses_steps)));
  if (plan.solver->goes_by_bounces) return;
  std::string flag;
  if (plan.look.light != Light::kAll) flag = "--light";
  if (plan.shows_passes()) flag = fmt::format("--false-color {}", plan.look.false_color->name);
  if (plan.animate_passes) flag = "--animation passes";
  if (!flag.empty())
    throw UserError("usage", fmt::format("{}: expected --solver {}, found {}", flag,
                                         name_solvers(&Solver::goes_by_bounces), plan.solver->name));
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
  plan.solver = options.solver;
  if (!options.max_patches)
    scene.solver.patch_count_max = std::min(scene.solver.patch_count_max, plan.solver->patch_count_usual);
  if (plan.solver->goes_by_bounces) {
    plan.step_count_max = scene.solver.pass_count_max;
    plan.snapshots =
        pick_snapshots(scene.output.snapshots, options.snapshots_all, scene.solver.pass_count_max);
    return;
  }
  scene.output.ambient = options.ambient;
  plan.snapshots = options.shots.empty() ? std::vector<uint32_t>{kLastStep} : options.shots;
  plan.step_count_max = options.shots.empty() ? kShotsMax : options.shots.back();
}

}  // namespace

bool Plan::has_pictures() const {
  return storyboard || animate_passes || animate_shots ||
         has_any(*this, [](const Exporter& row) { return row.encode_picture != nullptr; });
}

bool Plan::is_exposed() const {
  return storyboard || animate_passes || animate_shots ||
         has_any(*this, [](const Exporter& row) { return row.exposed; });
}

bool Plan::shows_displays() const {
  return storyboard || animate_shots ||
         has_any(*this, [](const Exporter& row) { return row.encode_picture != nullptr && row.exposed; });
}

bool Plan::has_layers() const {
  return has_any(*this, [](const Exporter& row) { return row.layers; });
}

bool Plan::records_passes() const {
  return has_any(*this, [](const Exporter& row) { return row.records; });
}

bool Plan::shows_passes() const { return look.false_color != nullptr && look.false_color->of_passes; }

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
  override_with(scene.solver.error, options.error);
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
  for (const std::string& format : options.formats)
    for (const Exporter& row : exporters())
      if (row.format == format) plan.exporters.push_back(&row);
  plan.limits = options.load.limits;
  plan.bytes_max = options.max_memory ? *options.max_memory : find_memory_available();
  plan.seconds_max = options.max_seconds;
  plan.thread_count = options.threads ? *options.threads : thread_count_default();
  plan.starting_patches = count_starting_patches(scene.faces, scene.solver);
  scene.solver.keep_rows =
      options.keep_rows ? *options.keep_rows : forecast_run(scene, plan).bytes_most <= plan.bytes_max;
  return plan;
}

std::string name_camera(const Plan& plan, const Camera& camera) {
  return plan.cameras_named ? plan.stem + "-" + camera.name : plan.stem;
}

std::string make_picture_name(const Plan& plan, const Scene& scene, const Camera& camera, uint32_t step,
                              const Exporter& exporter) {
  const Look& look = plan.look;
  const bool display = exporter.exposed, mesh = plan.mesh && display;
  const FalseColor* color = display ? look.false_color : nullptr;
  // Where colours belong to patches there are flat pictures only, and beside them only flat numbers.
  const bool of_patches = look.false_color != nullptr && look.false_color->of_patches;
  const bool flat = of_patches ? !display : scene.output.shading == Shading::kFlat;
  const bool lit = color == nullptr || color->of_light;
  const std::string place =
      step == kLastStep ? "solution" : fmt::format("{}-{:0{}}", plan.solver->step, step, plan.solver->digits);
  return fmt::format(
      "{}-{}{}{}{}{}{}{}.{}", name_camera(plan, camera), place, scene.output.ambient ? "-ambient" : "",
      lit && look.light != Light::kAll ? "-" + kLightNames[static_cast<size_t>(look.light)] : "",
      color != nullptr ? fmt::format("-{}", color->name) : "",
      display && color == nullptr && look.tone != nullptr ? fmt::format("-{}", look.tone->name) : "",
      flat ? "-flat" : "", mesh ? "-mesh" : "", exporter.format);
}

RunForecast forecast_run(const Scene& scene, const Plan& plan) {
  const FaceTable& faces = scene.faces;
  const SolverSettings& settings = scene.solver;
  const uint64_t start = plan.starting_patches;
  const uint64_t solver_bytes = plan.solver->forecast_bytes(faces, settings, start);
  const Forecast solve = forecast_solve(faces, settings, start, scene.sky);
  Bytes bytes = {kProgramBytes + solve.bytes + static_cast<double>(solver_bytes),
                 forecast_bytes(faces, settings, start) + solver_bytes};
  double seconds = solve.seconds + plan.solver->forecast_seconds(faces, settings, start);
  // Files of the whole solution are written one after the other.
  uint64_t bytes_per_patch = 0;
  for (const Exporter* exporter : plan.exporters)
    bytes_per_patch = std::max<uint64_t>(bytes_per_patch, exporter->bytes_per_patch);
  bytes.most += bytes_per_patch * settings.patch_count_max;
  if (makes_films(plan, scene)) {
    uint64_t largest = 0;
    for (const Camera& camera : plan.cameras) {
      const uint64_t pixels = uint64_t{camera.width} * camera.height;
      const auto count = static_cast<double>(pixels);
      largest = std::max(largest, pixels);
      bytes.likely += count * kFilmBytes.likely;
      bytes.most += pixels * kFilmBytes.most;
      seconds += forecast_film_seconds(faces, count) +
                 count * kPictureSeconds * static_cast<double>(plan.snapshots.size());
    }
    bytes.likely += static_cast<double>(largest) * kPictureBytes.likely;
    bytes.most += largest * kPictureBytes.most + forecast_series_bytes(scene, plan);
    for (const Exporter* exporter : plan.exporters) bytes.most += largest * exporter->bytes_per_pixel;
  }
  const auto threads = static_cast<double>(plan.thread_count);
  return {bytes.most, static_cast<uint64_t>(bytes.likely),
          seconds / std::max(1.0, threads * kShareOfThreads)};
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
  const RunForecast forecast = forecast_run(scene, plan);
  if (forecast.bytes_most > plan.bytes_max)
    throw UserError("memory-limit",
                    fmt::format("the run may need {}; the limit is {}, what is available unless --max-memory "
                                "says another; lower max_patches, rays or size",
                                format_bytes(forecast.bytes_most), format_bytes(plan.bytes_max)),
                    scene.file);
  if (forecast.seconds > plan.seconds_max)
    throw UserError(
        "time-limit",
        fmt::format("the run will likely take {}; the limit is {} (--max-seconds raises it); lower "
                    "max_patches, rays or size",
                    format_seconds(forecast.seconds), format_seconds(plan.seconds_max)),
        scene.file);
}

}  // namespace patchlight
