// The verb render. The run is a straight line: load, make the tables, refine, look, then pass by pass; each
// asked picture is on its way to its file as soon as its pass is done.
#include "render.h"

#include "engine/base/parallel.h"
#include "lit_mesh.h"
#include "pictures.h"
#include "series.h"
#include "start.h"
#include "stop.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>

namespace patchlight {
namespace {

constexpr int kExitNotConverged = 6;

// Sends the pictures of the current state to the files of all `steps`.
void write_snapshots(Run& run, std::span<const uint32_t> steps) {
  if (steps.empty() || !run.plan.has_pictures()) return;
  Stopwatch watch;
  const std::vector<Rgb> radiosity = find_radiosity(run);
  check_values(run, radiosity);
  const std::vector<Rgb> lit = pick_light(run.light, radiosity, run.plan.look.light);
  std::vector<Rgb> shown;
  if (wants(run, PixelKind::kDisplay)) shown = show_values(run, lit);
  take_snapshot(run, radiosity, shown);
  for (size_t k = 0; k < run.films.size(); ++k)
    for (const Exporter* exporter : run.plan.exporters) {
      if (!has_pixels(exporter->pixels)) continue;
      const bool display = exporter->pixels == PixelKind::kDisplay;
      auto picture =
          std::make_shared<Picture>(take_picture(run, run.films[k], display ? shown : lit, exporter->pixels));
      if (exporter->pixels == PixelKind::kLayers) add_layers(*picture, run, k, radiosity);
      std::vector<std::string> paths;
      for (const uint32_t step : steps)
        paths.push_back(run.folder + "/" +
                        make_picture_name(run.plan, run.scene, run.plan.cameras[k], step, *exporter));
      run.report.seconds.render += watch.lap();
      push_job(run.jobs, [picture, paths, encode = exporter->encode_picture] {
        const std::string bytes = encode(*picture);
        for (const std::string& path : paths) write_file(path, bytes);
      });
      run.pictures.insert(run.pictures.end(), paths.begin(), paths.end());
      run.report.seconds.write += watch.lap();
    }
}

void write_tables(Run& run) {
  Stopwatch watch;
  for (const Exporter* exporter : run.plan.exporters) {
    if (exporter->pixels != PixelKind::kNoPixels) continue;
    NewFile file;
    open_file(file,
              fmt::format("{}/{}{}.{}", run.folder, run.plan.stem, exporter->name_end, exporter->format));
    if (exporter->export_passes != nullptr)
      exporter->export_passes(file, run.scene, run.solution, run.record);
    else
      exporter->export_solution(file, run.scene, run.solution);
    commit_file(file);
    run.tables.push_back(file.path);
  }
  run.report.seconds.write += watch.lap();
}

void refine_all(Run& run) {
  const auto tell = [&] {
    take_round(run);
    say_progress(run.talk,
                 fmt::format("refining: {} patches", format_count(run.solution.mesh.elements.size())));
  };
  run.solution = make_solution(make_surfaces(run.scene.faces), run.scene.solver);
  tell();
  while (refine(run.solution)) tell();
}

void say_step(Run& run, const PassReport& step) {
  const Plan& plan = run.plan;
  if (plan.snapshots.back() != kSolutionStep)
    say_progress(run.talk, fmt::format("{} {} of {}", plan.solver->step, step.pass, plan.step_count_max));
  else
    say_progress(run.talk, fmt::format("{} {}, unshot {:.2g} of {:.2g}", plan.solver->step, step.pass,
                                       sum_channels(step.unshot_power), run.solution.shooting->power));
}

void advance_all(Run& run) {
  const Solver& solver = *run.plan.solver;
  std::span<const uint32_t> snapshots = run.plan.snapshots;
  run.record.step = solver.step;
  bool last = false;
  while (!last) {
    const PassReport& step = solver.advance(run.solution);
    const bool converged = solver.is_converged(run.solution);
    last = converged || step.pass == run.plan.step_count_max;
    if (last) run.report.stopped_reason = converged ? "converged" : name_steps(solver.step);
    say_step(run, step);
    keep_light(run);
    take_pass(run);
    if (run.plan.records_passes())
      record_pass(run.record, run.solution, find_shown_ambient(run.scene, run.solution),
                  *run.scene.output.exposure_ev, last);
    // A run that ends early writes all that was asked for.
    size_t due = 0;
    while (due < snapshots.size() && (last || snapshots[due] == step.pass)) ++due;
    write_snapshots(run, snapshots.first(due));
    snapshots = snapshots.subspan(due);
  }
}

// Everything that may be cancelled.
void solve(Run& run) {
  refine_all(run);
  freeze(run.solution);
  start_pictures(run);
  try {
    advance_all(run);
  } catch (const std::domain_error&) {
    throw UserError("singular-system",
                    "light never dies in this scene, so that the system of equations has no solution: some "
                    "reflectance must be below 1, or some light must leave",
                    run.scene.file);
  }
  write_series(run);
  write_plots(run);
  write_tables(run);
  run.report.power = find_power_ledger(run.solution);
  run.report.health = find_health(run.scene, run.solution);
  run.report.objects = find_object_power(run.scene, run.solution);
  run.report.solution_hash = find_solution_hash(run.solution);
}

void write_report(Run& run, const std::string& path, Stopwatch& whole) {
  StageSeconds& seconds = run.report.seconds;
  seconds.trace = run.solution.log.trace_seconds;
  seconds.split = run.solution.log.split_seconds;
  seconds.solve = run.solution.log.solve_seconds;
  seconds.total = whole.lap();
  write_file(path, format_report(run.report, run.scene, run.solution));
  run.tables.insert(run.tables.begin(), path);
}

// "12 of 16 passes (converged)", "4,711 shots (converged)", "the whole system at once".
std::string describe_steps(const Run& run) {
  const std::string_view step = run.plan.solver->step;
  const size_t count = run.solution.log.passes.size();
  std::string why = run.report.stopped_reason;
  if (why == "signal")
    why = "stopped by " + run.report.stopped_signal;
  else if (why != "converged")
    why = "all that were asked for";
  if (run.plan.solver->takes_one_step) return count > 0 ? "the whole system at once" : why;
  if (run.plan.snapshots.back() == kSolutionStep) return fmt::format("{} {}s ({})", count, step, why);
  return fmt::format("{} of {} {} ({})", count, run.plan.step_count_max, name_steps(step), why);
}

// The largest net heat flows, those of sources and those of sinks.
void say_heat(Run& run) {
  constexpr size_t kShown = 8;
  const ObjectPowerTable& power = run.report.objects;
  std::vector<size_t> order(power.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto net = [&](size_t object) { return find_net_power(power, object).g; };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return std::abs(net(a)) > std::abs(net(b)); });
  std::string text;
  for (size_t k = 0; k < std::min(order.size(), kShown); ++k)
    text += fmt::format("{} {} {:+.5g} W", k == 0 ? "" : ",", escape_text(run.scene.object_ids[order[k]]),
                        net(order[k]));
  if (!text.empty())
    say(run.talk, fmt::format("net heat given off:{}{}", text, order.size() > kShown ? ", ..." : ""));
}

void say_summary(Run& run) {
  const RunReport& report = run.report;
  say(run.talk,
      fmt::format("{}: {}, {} patches, {} rays{}", run.plan.stem, describe_steps(run),
                  run.solution.mesh.elements.size(), format_count(count_rays(report, run.solution)),
                  report.power ? fmt::format(", closure error {:.2g}", report.power->closure_error) : ""));
  if (run.scene.is_heat) say_heat(run);
  const StageSeconds& s = report.seconds;
  say(run.talk, fmt::format("seconds: load {:.2f}, trace {:.2f}, split {:.2f}, solve {:.2f}, render {:.2f}, "
                            "write {:.2f}, total {:.2f}",
                            s.load, s.trace, s.split, s.solve, s.render, s.write, s.total));
  if (report.exposure_ev)
    say(run.talk, fmt::format("exposure: EV {0:.2f}; --exposure {0:.2f} repeats it", *report.exposure_ev));
  say(run.talk, fmt::format("files: {} in {}", run.tables.size() + run.pictures.size(), run.folder));
}

void warn_not_converged(Run& run) {
  const std::vector<PassReport>& passes = run.solution.log.passes;
  const double until = run.scene.solver.until;
  if (run.report.stopped_reason != "passes" || until <= 0 || passes.front().added_largest <= 0) return;
  say_warning(
      run.talk, "not-converged",
      fmt::format("pass {} still added {:.2g} % of what pass 1 added, and until is {:g} %: more passes would "
                  "change the picture",
                  passes.size(), 100 * passes.back().added_largest / passes.front().added_largest,
                  100 * until),
      run.scene.file);
}

}  // namespace

int render(const Options& options, Talk& talk) {
  Stopwatch whole, watch;
  if (!options.json) check_standard_output();
  std::vector<Diagnostic> warnings;
  Run run(talk);
  run.scene = load_scene(options.scene, warnings, options.load);
  say_diagnostics(talk, warnings);
  run.plan = make_plan(run.scene, options);
  check_limits(run.scene, run.plan);
  run.report.solver = *run.plan.solver;
  run.report.forecast_bytes = forecast_run_bytes(run.scene, run.plan);
  const WorkersScope scope(start_workers(options, talk));
  run.report.thread_count = current_workers()->thread_count();
  const StopSignals signals(*current_workers());  // From here on there may be files to clean up.
  const OutputFolder folder = open_output_folder(options.out);
  run.folder = folder.path;
  const std::string report_path =
      options.report.empty() ? fmt::format("{}/{}-report.json", run.folder, run.plan.stem) : options.report;
  check_file_writable(report_path);

  run.report.seconds.load = watch.lap();
  try {
    solve(run);
  } catch (const Cancelled&) {
    run.report.stopped_reason = "signal";
    run.report.stopped_signal = stop_signal() == SIGTERM ? "SIGTERM" : "SIGINT";
  }
  watch.lap();
  finish_jobs(run.jobs);
  run.report.seconds.write += watch.lap();
  write_report(run, report_path, whole);

  warn_not_converged(run);
  say_diagnostics(talk, describe_leaks(run.scene, run.report.health.leaks));
  say_summary(run);
  if (!options.json) {
    std::string paths;
    for (const std::string& path : run.tables) paths += path + "\n";
    for (const std::string& path : run.pictures) paths += path + "\n";
    print_result(paths);
  }
  if (run.report.stopped_reason == "signal") return 128 + stop_signal();
  return options.require_convergence && run.report.stopped_reason != "converged" ? kExitNotConverged : 0;
}

}  // namespace patchlight
