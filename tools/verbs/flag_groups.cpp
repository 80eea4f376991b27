// Flags that several verbs have.
#include "tools/verbs/flag_groups.h"

#include "dsl/report/limits.h"
#include "engine/solve/solvers.h"
#include "tools/base/flag_values.h"
#include "tools/base/format.h"
#include "tools/image/tone.h"

#include <fmt/format.h>

namespace patchlight {
namespace {

// Limits of what a scene may cost, a flag a row of their table.
void add_limit_flags(Usage& usage, Options& options) {
  add_value(usage, "--max-memory", "BYTES",
            "refuse a run that may need more, such as 2G; what is available unless given",
            [&](const std::string& text) { options.max_memory = parse_bytes("--max-memory", text); });
  add_value(usage, "--max-seconds", "S",
            fmt::format("refuse a run that will likely take longer; {} unless given", options.max_seconds),
            [&](const std::string& text) {
              options.max_seconds = parse_number("--max-seconds", text, 0.001, 1e12);
            });
  for (const LimitRow& row : kLimitRows) {
    const uint64_t usual = Limits{}.*row.limit;
    add_value(usage, row.flag, "N", fmt::format("{} {}; {} unless given", row.unit, row.description, usual),
              [&options, row](const std::string& text) {
                options.load.limits.*row.limit = parse_count(row.flag, text, 1, row.highest);
              });
  }
  for (Flag& flag : usage.flags)
    if (flag.name.starts_with("--max-")) flag.group = "Limits";
}

// Flags that only some solvers know are never ignored.
void check_solver_flags(const Options& options) {
  const Solver& solver = *options.solver;
  if (!solver.chooses_steps && !options.shots.empty())
    fail_usage(fmt::format("--shots: only --solver {} has shots", name_solvers(&Solver::chooses_steps)));
  if (!solver.leaves_unshot && options.ambient)
    fail_usage(fmt::format("--ambient: only --solver {} estimates what is unshot",
                           name_solvers(&Solver::leaves_unshot)));
  if (solver.goes_by_bounces) return;
  if (options.passes) fail_usage(fmt::format("--passes: --solver {} has no passes", solver.name));
  if (options.snapshots_all || !options.snapshots.empty())
    fail_usage(fmt::format("--snapshots: --solver {} has no passes{}", solver.name,
                           solver.chooses_steps ? "; --shots asks for pictures after shots" : ""));
}

}  // namespace

void add_scene(Usage& usage, Options& options) {
  usage.argument = {.name = "SCENE", .help = "a scene file; - reads standard input", .word = &options.scene};
  usage.checks.push_back([&] {
    if (options.scene.empty()) fail_usage("expected a scene file");
  });
  add_list(usage, "-D", "NAME=VALUE", "a variable of the scene, stronger than its let",
           options.load.definitions);
  add_list(usage, "--set", "PATH=VALUE", "any value of the scene, such as solver.rays=64",
           options.load.overrides);
}

void add_talk_flags(Usage& usage, Options& options) {
  add_switch(usage, "--quiet", options.quiet, "no progress and no summary");
  add_switch(usage, "--json", options.json,
             "messages as a JSON list on standard output, and nothing else there");
  add_choice(usage, "--color", {"auto", "always", "never"}, "colours; auto honours NO_COLOR",
             [&](size_t choice) { options.color = static_cast<ColorChoice>(choice); });
}

void add_run_flags(Usage& usage, Options& options) {
  add_value(usage, "--threads", "N", "threads; all cores unless given", [&](const std::string& text) {
    options.threads = static_cast<uint32_t>(parse_count("--threads", text, 1, kThreadsMax));
  });
  add_value(usage, "--seed", "N", "another seed, other samples", [&](const std::string& text) {
    options.seed = parse_count("--seed", text, 0, 4'000'000'000'000'000'000);
  });
  add_limit_flags(usage, options);
}

void add_solver_flags(Usage& usage, Options& options) {
  add_value(usage, "--passes", "N", "at most so many passes (bounces of light)",
            [&](const std::string& text) {
              options.passes = static_cast<uint32_t>(parse_count("--passes", text, 1, kPassesFlagMax));
            });
  add_value(usage, "--rays", "N", "rays a row of form factors; more: less noise, more time",
            [&](const std::string& text) {
              options.rays = static_cast<uint32_t>(parse_count("--rays", text, 1, 1'000'000));
            });
  add_value(
      usage, "--error", "E",
      "what the light may be off by, mean over mean; less: more rays and smaller patches; 0.01 unless given",
      [&](const std::string& text) { options.error = parse_number("--error", text, kErrorMin, kErrorMax); });
  add_value(usage, "--quality", "Q",
            "about Q times the time that the error asked for would take, and less error; 1 unless given",
            [&](const std::string& text) {
              options.quality = parse_number("--quality", text, kQualityMin, kQualityMax);
            });
  add_value(usage, "--max-patches", "N", "the budget of patches", [&](const std::string& text) {
    options.max_patches = parse_count("--max-patches", text, 1, 1'000'000'000);
    options.load.limits.starting_patches = *options.max_patches;
  });
  add_choice(usage, "--form-factors", {"cached", "recompute"},
             "recompute: less memory, more time, the same result; as memory allows unless given",
             [&](size_t choice) { options.keep_rows = choice == 0; });
  add_run_flags(usage, options);
}

void add_method_flags(Usage& usage, Options& options) {
  std::vector<std::string> names;
  std::string ways = "the way to solve: ";
  for (const Solver& solver : solvers()) {
    names.emplace_back(solver.name);
    ways += fmt::format("{}: {}; ", solver.name, solver.summary);
  }
  add_choice(usage, "--solver", names, ways + std::string(solvers().front().name) + " unless given",
             [&](size_t choice) { options.solver = &solvers()[choice]; });
  add_value(
      usage, "--shots", "LIST",
      name_solvers(&Solver::chooses_steps) + ": pictures after these shots, such as 1-40,100, and then stop",
      [&](const std::string& text) { options.shots = parse_steps("--shots", text); });
  add_switch(
      usage, "--ambient", options.ambient,
      name_solvers(&Solver::leaves_unshot) + ": pictures show an estimate of the light that is unshot, too");
  usage.checks.push_back([&] { check_solver_flags(options); });
}

void add_picture_flags(Usage& usage, Options& options) {
  add_value(usage, "--snapshots", "LIST", "passes to picture: 1,2,16, or 1-4,16, or all",
            [&](const std::string& text) {
              options.snapshots_all = text == "all";
              if (!options.snapshots_all) options.snapshots = parse_steps("--snapshots", text);
            });
  add_value(usage, "--camera", "NAME", "only this camera of the scene", [&](const std::string& text) {
    if (text.empty()) fail_usage("--camera: expected the name of a camera");
    options.camera = text;
  });
  add_value(usage, "--size", "WxH", "pixels of the pictures, such as 960x720",
            [&](const std::string& text) { options.size = parse_size(text); });
}

void add_out_flag(Usage& usage, Options& options) {
  add_value(usage, "-o", "DIR", "where the files go; out unless given", [&](const std::string& text) {
    if (text.empty()) fail_usage("-o: expected a directory");
    options.out = text;
  });
}

void add_exposure_flag(Usage& usage, Options& options) {
  add_value(usage, "--exposure", "EV", "auto, or EV: the picture shows B * 2^EV",
            [&](const std::string& text) {
              options.exposure_auto = text == "auto";
              if (!options.exposure_auto) options.exposure_ev = parse_number("--exposure", text, -100, 100);
            });
}

void add_tone_flag(Usage& usage, Options& options) {
  std::string help;
  for (const Tone& tone : tones()) help += fmt::format("{}: {}; ", tone.name, tone.help);
  const std::vector<std::string> names = tone_names();
  add_choice(usage, "--tone", names, help + "clip unless given",
             [&options, names](size_t choice) { options.look.tone = find_tone(names[choice]); });
}

void add_look_flags(Usage& usage, Options& options) {
  add_choice(usage, "--shading", {"smooth", "flat"}, "smooth, or flat: one colour a patch",
             [&](size_t choice) { options.shading = static_cast<Shading>(choice); });
  add_exposure_flag(usage, options);
}

void add_common_flags(Usage& usage, Options& options) {
  add_scene(usage, options);
  add_solver_flags(usage, options);
  add_picture_flags(usage, options);
  add_talk_flags(usage, options);
}

}  // namespace patchlight
