// The main line of the verb render: load, make the tables, refine, look, then step by step; each asked
// picture is on its way to its file as soon as its step is done.
#include "tools/render/render.h"

#include "tools/base/format.h"
#include "tools/base/start.h"
#include "tools/base/stop.h"
#include "tools/export/exporters.h"
#include "tools/export/lit_mesh.h"
#include "tools/render/dark.h"
#include "tools/render/pictures.h"
#include "tools/render/series.h"
#include "tools/render/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>

namespace patchlight {
namespace {

constexpr int kExitNotConverged = 6;

// All that a run makes, owned here; each stage gets its part of it. It outlives a run that is stopped.
struct Made {
  Solution solution;
  PictureState pictures;
  Series series;
  PassRecord record;  // of passes so far, where a format asks for it
  RunReport report;
  OutputFiles files;
};

// Sends the pictures of a snapshot to the files of all `steps`.
void send_pictures(Made& made, const Task& task, const Snapshot& snapshot, std::span<const Rgb> lit,
                   std::span<const uint32_t> steps) {
  const Plan& plan = task.plan;
  StageSeconds& seconds = made.report.seconds;
  for (size_t k = 0; k < made.pictures.films.size(); ++k)
    for (const Exporter* exporter : plan.exporters) {
      if (exporter->encode_picture == nullptr) continue;
      std::shared_ptr<Picture> picture;
      {
        const StageTimer timer(seconds.render);
        const FilmTable& film = made.pictures.films[k];
        picture = std::make_shared<Picture>(exporter->exposed
                                                ? show_film(task, made.pictures, k, snapshot.shown)
                                                : Picture{film.width, film.height, expose(film, lit)});
        if (!exporter->exposed && shows_sky(plan)) add_sky(picture->pixels, film, find_sky_values(film));
        if (exporter->layers) add_layers(*picture, task, made.pictures, k, snapshot.radiosity);
      }
      const StageTimer timer(seconds.write);
      std::vector<std::string> paths;
      for (const uint32_t step : steps)
        paths.push_back(made.files.folder + "/" +
                        make_picture_name(plan, task.scene, plan.cameras[k], step, *exporter));
      push_job(made.files.jobs, [picture, paths, encode = exporter->encode_picture] {
        const std::string bytes = encode(*picture);
        for (const std::string& path : paths) write_file(path, bytes);
      });
      made.files.pictures.insert(made.files.pictures.end(), paths.begin(), paths.end());
    }
}

// Pictures the current state, which stands for all `steps`.
void take_pictures(Made& made, const Task& task, std::span<const uint32_t> steps, bool converged,
                   Talk& talk) {
  if (steps.empty() || !task.plan.has_pictures()) return;
  Snapshot snapshot{.radiosity = {}, .shown = {}, .converged = converged};
  std::vector<Rgb> lit;
  {
    const StageTimer timer(made.report.seconds.render);
    snapshot.radiosity = find_radiosity(task, made.solution);
    check_values(snapshot.radiosity, made.solution.log.passes.size(), task.scene.file, talk);
    lit = pick_light(made.pictures.light, snapshot.radiosity, task.plan.look.light);
    if (task.plan.shows_displays()) snapshot.shown = show_values(task, made.pictures, made.solution, lit);
    take_snapshot(made.series, task, made.pictures, made.solution, snapshot);
  }
  send_pictures(made, task, snapshot, lit, steps);
}

void write_run_file(const Made& made, const Task& task, const Exporter& exporter, const std::string& path) {
  NewFile file;
  open_file(file, path);
  exporter.export_run(file, {task.scene, made.solution, made.record, made.report, task.plan.stem});
  commit_file(file);
}

void write_run_files(Made& made, const Task& task) {
  for (const Exporter* exporter : task.plan.exporters) {
    if (exporter->export_run == nullptr) continue;
    const std::string path = made.files.folder + "/" + name_run_file(task.plan.stem, *exporter);
    write_run_file(made, task, *exporter, path);
    made.files.tables.push_back(path);
  }
}

void advance_all(Made& made, const Task& task, Talk& talk) {
  const Plan& plan = task.plan;
  std::span<const uint32_t> snapshots = plan.snapshots;
  made.record.solver = plan.solver;
  take_steps(made.solution, plan, plan.step_count_max, talk, [&](const StepEnd& end) {
    if (end.last) made.report.stopped_reason = end.converged ? "converged" : name_steps(plan.solver->step);
    {
      const StageTimer timer(made.report.seconds.render);
      keep_light(made.pictures.light, task, made.solution);
      take_pass(made.series, task, made.pictures, made.solution, end.converged);
    }
    if (plan.records_passes())
      record_pass(made.record, made.solution, find_shown_ambient(task.scene, made.solution),
                  *made.pictures.exposure_ev, end.last);
    // A run that ends early writes all that was asked for.
    size_t due = 0;
    while (due < snapshots.size() && (end.last || snapshots[due] == end.step.pass)) ++due;
    take_pictures(made, task, snapshots.first(due), end.converged, talk);
    snapshots = snapshots.subspan(due);
  });
}

// Everything that may be cancelled.
void solve(Made& made, const Task& task, Talk& talk) {
  StageSeconds& seconds = made.report.seconds;
  solve_mesh(made.solution, task.scene, talk, [&] {
    const StageTimer timer(seconds.render);
    take_round(made.series, task, made.solution);
  });
  {
    const StageTimer timer(seconds.render);
    made.pictures = start_pictures(task, made.solution);
    made.report.exposure_ev = made.pictures.exposure_ev;
    start_storyboard(made.series, task, made.solution);
  }
  try {
    advance_all(made, task, talk);
  } catch (const std::domain_error&) {
    throw UserError("singular-system",
                    "light never dies in this scene, so that the system of equations has no solution: some "
                    "reflectance must be below 1, or some light must leave",
                    task.scene.file);
  }
  {
    const StageTimer timer(seconds.write);
    write_series(made.files, made.series, task, made.pictures, made.solution);
    write_run_files(made, task);
  }
  made.report.power = find_power_ledger(made.solution);
  if (task.plan.solver->goes_by_bounces)
    made.report.error =
        find_error(made.solution, is_smooth(task) ? made.pictures.films : std::vector<FilmTable>());
  made.report.health = find_health(task.scene, made.solution);
  made.report.objects = find_object_power(task.scene, made.solution);
  made.report.solution_hash = find_solution_hash(made.solution);
}

void write_report(Made& made, const Task& task, const std::string& path, Stopwatch& whole) {
  RunReport& report = made.report;
  report.film_rays = made.pictures.ray_count + made.series.ray_count;
  report.film_bytes = made.pictures.bytes;
  report.seconds.trace = made.solution.log.trace_seconds;
  report.seconds.split = made.solution.log.split_seconds;
  report.seconds.solve = made.solution.log.solve_seconds;
  report.seconds.total = whole.lap();
  write_run_file(made, task, find_report(), path);
  made.files.tables.insert(made.files.tables.begin(), path);
}

// "12 of 16 passes (converged)", "4,711 shots (converged)", "the whole system at once".
std::string describe_steps(const Plan& plan, const RunReport& report, size_t count) {
  const Solver& solver = *plan.solver;
  std::string why = report.stopped_reason;
  if (why == "signal")
    why = "stopped by " + report.stopped_signal;
  else if (why != "converged")
    why = "all that were asked for";
  if (solver.takes_one_step) return count > 0 ? "the whole system at once" : why;
  if (plan.snapshots.back() == kLastStep) return fmt::format("{} {}s ({})", count, solver.step, why);
  return fmt::format("{} of {} {} ({})", count, plan.step_count_max, name_steps(solver.step), why);
}

// The largest net heat flows, those of sources and those of sinks.
void say_heat(const Scene& scene, const ObjectPowerTable& power, Talk& talk) {
  constexpr size_t kShown = 8;
  std::vector<size_t> order(power.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto net = [&](size_t object) { return find_net_power(power, object).g; };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return std::abs(net(a)) > std::abs(net(b)); });
  std::string text;
  for (size_t k = 0; k < std::min(order.size(), kShown); ++k)
    text += fmt::format("{} {} {:+.5g} W", k == 0 ? "" : ",", escape_text(scene.object_ids[order[k]]),
                        net(order[k]));
  if (!text.empty())
    say(talk, fmt::format("net heat given off:{}{}", text, order.size() > kShown ? ", ..." : ""));
}

void say_summary(const Made& made, const Task& task, Talk& talk) {
  const RunReport& report = made.report;
  const Solution& solution = made.solution;
  say(talk,
      fmt::format("{}: {}, {} patches, {} rays{}", task.plan.stem,
                  describe_steps(task.plan, report, solution.log.passes.size()),
                  solution.mesh.elements.size(), format_count(count_rays(report, solution)),
                  report.power ? fmt::format(", closure error {:.2g}", report.power->closure_error) : ""));
  if (task.scene.is_heat) say_heat(task.scene, report.objects, talk);
  const StageSeconds& s = report.seconds;
  say(talk, fmt::format("seconds: load {:.2f}, trace {:.2f}, split {:.2f}, solve {:.2f}, render {:.2f}, "
                        "write {:.2f}, total {:.2f}",
                        s.load, s.trace, s.split, s.solve, s.render, s.write, s.total));
  if (report.exposure_ev)
    say(talk, fmt::format("exposure: EV {0:.2f}; --exposure {0:.2f} repeats it", *report.exposure_ev));
  say(talk, fmt::format("files: {} in {}", made.files.tables.size() + made.files.pictures.size(),
                        made.files.folder));
}

void warn_not_converged(const Scene& scene, const RunReport& report, std::span<const PassReport> passes,
                        Talk& talk) {
  const double until = scene.solver.until;
  if (report.stopped_reason != "passes" || until <= 0 || passes.front().added_largest <= 0) return;
  // Both must fall below `until`: the larger one is what keeps it from the end.
  const double largest = double{passes.back().added_largest} / passes.front().added_largest;
  const double power =
      sum_channels(passes.back().added_power) / std::max(sum_channels(passes.front().added_power), 1e-300);
  say_warning(
      talk, "not-converged",
      fmt::format("pass {} still added {:.3g} % of the {} that pass 1 added, and until is {:g} %: more "
                  "passes would change the picture",
                  passes.size(), 100 * std::max(largest, power),
                  power > largest ? "power" : "largest radiosity", 100 * until),
      scene.file);
}

// Where the ledger does not close, light is missing or too much somewhere.
constexpr double kClosureTold = 0.003;
constexpr double kErrorTold = 2;
void warn_not_closed(const Scene& scene, const RunReport& report, Talk& talk) {
  if (!report.power || report.power->closure_error <= kClosureTold) return;
  say_warning(
      talk, "not-closed",
      fmt::format("{:.2g} % of the emitted power is not accounted for: somewhere light is too bright or too "
                  "dark; --quality 4 may help, surfaces that lie in one another may be the cause",
                  100 * report.power->closure_error),
      scene.file);
}

// Told only where twice as much is likely: the estimate is one.
void warn_budget_reached(const Scene& scene, const RunReport& report, Talk& talk) {
  if (!report.error || report.stopped_reason != "converged") return;
  const ErrorParts& parts = report.error->shown;
  const double asked = scene.solver.error;
  if (parts.estimate() <= kErrorTold * asked) return;
  const bool mesh = parts.mesh >= std::max(parts.noise_direct, parts.noise_rows);
  say_warning(
      talk, "budget-reached",
      fmt::format("the light may be off by {:.2g} % on average, and {:g} % was asked for: mostly {}; {}",
                  100 * parts.estimate(), 100 * asked,
                  mesh                                    ? "by patches that are too large for its edges"
                  : parts.noise_direct > parts.noise_rows ? "by noise of lamps that are seen in part"
                                                          : "by noise of the light of surfaces",
                  mesh ? "more max_patches or --quality 4 would help" : "--quality 4 would help"),
      scene.file);
}

}  // namespace

int render(const Options& options, Talk& talk) {
  Stopwatch whole, loading;
  const RenderOptions& own = get_own<RenderOptions>(options);
  if (!options.json) check_standard_output();
  std::vector<Diagnostic> warnings;
  Scene scene = load_scene(options.scene, warnings, options.load);
  say_diagnostics(talk, warnings);
  const Plan plan = make_plan(scene, options);
  check_limits(scene, plan);
  const Task task{scene, plan};
  Made made;
  RunReport& report = made.report;
  report.solver = *plan.solver;
  report.forecast_bytes = forecast_run(scene, plan).bytes_most;
  const WorkersScope scope(start_workers(options, talk));
  report.thread_count = current_workers()->thread_count();
  const StopSignals signals(*current_workers());  // From here on there may be files to clean up.
  const OutputFolder folder = open_output_folder(options.out);
  made.files.folder = folder.path;
  const std::string report_path =
      own.report.empty() ? folder.path + "/" + name_run_file(plan.stem, find_report()) : own.report;
  check_file_writable(report_path);
  report.seconds.load = loading.lap();

  try {
    solve(made, task, talk);
  } catch (const Cancelled&) {
    report.stopped_reason = "signal";
    report.stopped_signal = stop_signal() == SIGTERM ? "SIGTERM" : "SIGINT";
  }
  {
    const StageTimer timer(report.seconds.write);
    finish_jobs(made.files.jobs);
  }
  write_report(made, task, report_path, whole);

  warn_not_converged(scene, report, made.solution.log.passes, talk);
  warn_not_closed(scene, report, talk);
  warn_budget_reached(scene, report, talk);
  if (report.stopped_reason != "signal") warn_of_dark(task, made.pictures, made.solution, talk);
  say_diagnostics(talk, describe_leaks(scene, report.health.leaks));
  say_summary(made, task, talk);
  if (!options.json) {
    std::string paths;
    for (const std::string& path : made.files.tables) paths += path + "\n";
    for (const std::string& path : made.files.pictures) paths += path + "\n";
    print_result(paths);
  }
  if (report.stopped_reason == "signal") return 128 + stop_signal();
  return own.require_convergence && report.stopped_reason != "converged" ? kExitNotConverged : 0;
}

}  // namespace patchlight
