// The verb verify: solve as render does, but compare means in place of taking pictures.
#include "engine/base/parallel.h"
#include "tools/base/files.h"
#include "tools/base/format.h"
#include "tools/base/start.h"
#include "tools/base/stop.h"
#include "tools/render/expectations.h"
#include "tools/render/solve.h"
#include "tools/verbs/flag_groups.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Solves a scene and compares the light with what the scene says under `expect:`.

Examples:
  patchlight verify room.yaml                       exit code 0: as expected, 1: not so
  patchlight verify room.yaml --rays 1024           is a difference only noise?

In the scene:
  expect:
    - {object: hall.floor, pass: 16, radiosity: [1.2, 1.1, 0.9], tolerance: 0.02}

Compared are area means, after that pass; a run that converged earlier is compared as it stands at its end.
)";

// What came of each expectation of the scene.
struct Results {
  std::vector<DRgb> found;
  std::vector<uint8_t> met;
};

void compare(const Scene& scene, const Solution& solution, size_t k, Results& results) {
  const Expectation& expectation = scene.expectations[k];
  results.found[k] = find_mean_radiosity(solution, scene, expectation);
  results.met[k] = is_met(expectation, results.found[k]);
}

// Solves as far as the expectations need. One that names a pass that the run did not reach, because it had
// converged, is compared with its end.
Results solve(const Scene& scene, const Plan& plan, Talk& talk) {
  Results results;
  results.found.resize(scene.expectations.size());
  results.met.resize(scene.expectations.size());
  uint32_t pass_last = 0;
  for (const Expectation& expectation : scene.expectations) pass_last = std::max(pass_last, expectation.pass);
  Solution solution;
  const auto compare_due = [&](uint32_t pass, bool last) {
    for (size_t k = 0; k < scene.expectations.size(); ++k) {
      const uint32_t due = scene.expectations[k].pass;
      if (due == pass || (last && due > pass)) compare(scene, solution, k, results);
    }
  };
  solve_mesh(solution, scene, talk);
  compare_due(0, pass_last == 0);
  if (pass_last > 0)
    take_steps(solution, plan, pass_last, talk,
               [&](const StepEnd& end) { compare_due(end.step.pass, end.last); });
  return results;
}

// Passes that the flags changed: an expectation without a pass follows, one that names a later pass cannot.
void fit_passes(Scene& scene) {
  for (Expectation& expectation : scene.expectations) {
    if (expectation.after_last) expectation.pass = scene.solver.pass_count_max;
    if (expectation.pass > scene.solver.pass_count_max)
      throw UserError(
          "snapshot-beyond-passes",
          fmt::format("pass {} of '{}' is to be checked, but the run has {} passes at most", expectation.pass,
                      escape_text(expectation.object), scene.solver.pass_count_max),
          scene.file);
  }
}

// The result on standard output, and an error for each difference.
void report(const Scene& scene, const Results& results, Talk& talk) {
  std::vector<Diagnostic> missed;
  std::string text;
  for (size_t k = 0; k < scene.expectations.size(); ++k) {
    const Expectation& expectation = scene.expectations[k];
    const std::string line = describe_result(expectation, results.found[k]);
    text += fmt::format("{:8}{}\n", results.met[k] ? "as said" : "differs", line);
    if (results.met[k]) continue;
    Diagnostic& difference = missed.emplace_back();
    difference.file = expectation.file;
    difference.line = static_cast<int>(expectation.line);
    difference.column = static_cast<int>(expectation.column);
    difference.slug = "expectation-missed";
    difference.message = line;
  }
  say_progress_done(talk);
  if (talk.json)
    say_diagnostics(talk, missed);
  else
    print_result(text);
  say(talk, fmt::format("{} of {} expectations are met", scene.expectations.size() - missed.size(),
                        scene.expectations.size()));
}

}  // namespace

void describe_verify(Usage& usage, Options& options) {
  usage.help = kHelp;
  add_scene(usage, options);
  add_solver_flags(usage, options);
  add_talk_flags(usage, options);
}

int verify(const Options& options, Talk& talk) {
  if (!options.json) check_standard_output();
  std::vector<Diagnostic> warnings;
  Scene scene = load_scene(options.scene, warnings, options.load);
  say_diagnostics(talk, warnings);
  if (scene.expectations.empty())
    throw UserError("missing-key",
                    "the scene expects nothing: add `expect:`, a list such as "
                    "[{object: hall.floor, pass: 16, radiosity: 1.2, tolerance: 0.02}]",
                    scene.file);
  const Plan plan = make_plan(scene, options);
  fit_passes(scene);
  check_limits(scene, plan);
  const WorkersScope scope(start_workers(options, talk));
  const StopSignals signals(*current_workers());
  try {
    const Results results = solve(scene, plan, talk);
    report(scene, results, talk);
    return std::all_of(results.met.begin(), results.met.end(), [](uint8_t met) { return met; }) ? 0 : 1;
  } catch (const Cancelled&) {
    say(talk, "stopped by a signal; nothing was compared");
    return 128 + stop_signal();
  }
}

}  // namespace patchlight
