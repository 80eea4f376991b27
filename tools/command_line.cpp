// Command line -> Options; the one door to CLI11. CLI11 splits the words and prints the lists of flags;
// values are read here, because CLI11 takes nan for a number and 010 for eight. What a flag's value is called
// (FILE, DIR, a|b|c) is also what shells complete it with.
#include "command_line.h"

#include "completion.h"
#include "dsl/diagnostics.h"
#include "dsl/limits.h"
#include "engine/solve/solvers.h"
#include "exporters.h"
#include "flag_values.h"
#include "help.h"
#include "schema.h"
#include "version.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

namespace patchlight {
namespace {

using ReadValue = std::function<void(const std::string&)>;

// A flag with one value that `read` understands; CLI11 never sees it as a number.
void add_value(CLI::App& app, const std::string& names, const std::string& placeholder,
               const std::string& help, ReadValue read) {
  app.add_option_function<std::string>(names, std::move(read), help)->type_name(placeholder);
}

// A flag whose value is one of some words; `read` gets its index.
void add_choice(CLI::App& app, const std::string& name, const std::vector<std::string>& choices,
                const std::string& help, std::function<void(size_t)> read) {
  add_value(app, name, fmt::format("{}", fmt::join(choices, "|")), help,
            [=](const std::string& text) { read(parse_choice(name, text, choices)); });
}

// A flag without a value.
void add_switch(CLI::App& app, const std::string& name, bool& value, const std::string& help) {
  app.add_flag(name, value, help)->disable_flag_override();
}

// Limits of what a scene may cost, a flag a row of their table.
void add_limit_flags(CLI::App& app, Options& options) {
  add_value(app, "--max-memory", "BYTES",
            "refuse a run that may need more, such as 2G; what is available unless given",
            [&](const std::string& text) { options.max_memory = parse_bytes("--max-memory", text); });
  add_value(app, "--max-seconds", "S",
            fmt::format("refuse a run that will likely take longer; {} unless given", options.max_seconds),
            [&](const std::string& text) {
              options.max_seconds = parse_number("--max-seconds", text, 0.001, 1e12);
            });
  for (const LimitRow& row : kLimitRows) {
    const uint64_t usual = Limits{}.*row.limit;
    add_value(app, std::string(row.flag), "N",
              fmt::format("{} {}; {} unless given", row.unit, row.description, usual),
              [&options, row](const std::string& text) {
                options.load.limits.*row.limit = parse_count(row.flag, text, 1, row.highest);
              });
  }
  for (const CLI::Option* option : app.get_options())
    if (option->get_name().starts_with("--max-")) app.get_option(option->get_name())->group("Limits");
}

// The scene, and what changes it before it is read.
void add_scene(CLI::App& app, Options& options) {
  app.add_option("SCENE", options.scene, "a scene file; - reads standard input")->type_name("")->required();
  // One value each time, or they would swallow the scene.
  app.add_option("-D", options.load.definitions, "a variable of the scene, stronger than its let")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  app.add_option("--set", options.load.overrides, "any value of the scene, such as solver.rays=64")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
}

// How the program speaks.
void add_talk_flags(CLI::App& app, Options& options) {
  add_switch(app, "--quiet", options.quiet, "no progress and no summary");
  add_switch(app, "--json", options.json,
             "messages as a JSON list on standard output, and nothing else there");
  add_choice(app, "--color", {"auto", "always", "never"}, "colours; auto honours NO_COLOR",
             [&](size_t choice) { options.color = static_cast<ColorChoice>(choice); });
}

// Flags of all that casts rays.
void add_run_flags(CLI::App& app, Options& options) {
  add_value(app, "--threads", "N", "threads; all cores unless given", [&](const std::string& text) {
    options.threads = static_cast<uint32_t>(parse_count("--threads", text, 1, kThreadsMax));
  });
  add_value(app, "--seed", "N", "another seed, other samples", [&](const std::string& text) {
    options.seed = parse_count("--seed", text, 0, 4'000'000'000'000'000'000);
  });
  add_limit_flags(app, options);
}

// Flags that change what a solve takes.
void add_solver_flags(CLI::App& app, Options& options) {
  add_value(app, "--passes", "N", "at most so many passes (bounces of light)", [&](const std::string& text) {
    options.passes = static_cast<uint32_t>(parse_count("--passes", text, 1, kPassesFlagMax));
  });
  add_value(app, "--rays", "N", "rays a row of form factors; more: less noise, more time",
            [&](const std::string& text) {
              options.rays = static_cast<uint32_t>(parse_count("--rays", text, 1, 1'000'000));
            });
  add_value(app, "--quality", "Q",
            "more rays and smaller patches at once: about Q times the time, less error; 1 unless given",
            [&](const std::string& text) {
              options.quality = parse_number("--quality", text, kQualityMin, kQualityMax);
            });
  add_value(app, "--max-patches", "N", "the budget of patches", [&](const std::string& text) {
    options.max_patches = parse_count("--max-patches", text, 1, 1'000'000'000);
    options.load.limits.starting_patches = *options.max_patches;
  });
  add_choice(app, "--form-factors", {"cached", "recompute"},
             "recompute: less memory, more time, the same result; as memory allows unless given",
             [&](size_t choice) { options.keep_rows = choice == 0; });
  add_run_flags(app, options);
}

// Flags that choose another way to the light.
void add_method_flags(CLI::App& app, Options& options) {
  std::vector<std::string> names;
  for (const Solver& solver : solvers()) names.emplace_back(solver.name);
  add_choice(
      app, "--solver", names,
      "the way to solve: bounce by bounce, progressive refinement, or the whole linear system at once; "
      "passes unless given",
      [&](size_t choice) { options.solver = solvers()[choice].name; });
  add_value(app, "--shots", "LIST", "shooting: pictures after these shots, such as 1-40,100, and then stop",
            [&](const std::string& text) { options.shots = parse_steps("--shots", text); });
  add_switch(app, "--ambient", options.ambient,
             "shooting: pictures show an estimate of the light that is unshot, too");
}

// Flags that change which pictures there are.
void add_picture_flags(CLI::App& app, Options& options) {
  add_value(app, "--snapshots", "LIST", "passes to picture: 1,2,16, or 1-4,16, or all",
            [&](const std::string& text) {
              options.snapshots_all = text == "all";
              if (!options.snapshots_all) options.snapshots = parse_steps("--snapshots", text);
            });
  add_value(app, "--camera", "NAME", "only this camera of the scene", [&](const std::string& text) {
    if (text.empty()) fail_usage("--camera: expected the name of a camera");
    options.camera = text;
  });
  add_value(app, "--size", "WxH", "pixels of the pictures, such as 960x720",
            [&](const std::string& text) { options.size = parse_size(text); });
}

void add_out_flag(CLI::App& app, Options& options) {
  add_value(app, "-o", "DIR", "where the files go; out unless given", [&](const std::string& text) {
    if (text.empty()) fail_usage("-o: expected a directory");
    options.out = text;
  });
}

// How bright pictures are.
void add_exposure_flags(CLI::App& app, Options& options) {
  add_value(app, "--exposure", "EV", "auto, or EV: the picture shows B * 2^EV", [&](const std::string& text) {
    options.exposure_auto = text == "auto";
    if (!options.exposure_auto) options.exposure_ev = parse_number("--exposure", text, -100, 100);
  });
}

void add_tone_flag(CLI::App& app, Options& options) {
  add_choice(app, "--tone", kToneNames, "filmic: soft highlights; clip unless given",
             [&](size_t choice) { options.look.tone = static_cast<Tone>(choice); });
}

// Flags that change how pictures look.
void add_look_flags(CLI::App& app, Options& options) {
  add_choice(app, "--shading", {"smooth", "flat"}, "smooth, or flat: one colour a patch",
             [&](size_t choice) { options.shading = static_cast<Shading>(choice); });
  add_exposure_flags(app, options);
}

// What render, check and show have in common.
void add_common_flags(CLI::App& app, Options& options) {
  add_scene(app, options);
  add_solver_flags(app, options);
  add_picture_flags(app, options);
  add_talk_flags(app, options);
}

void add_check_flags(CLI::App& app, Options& options) {
  add_common_flags(app, options);
  add_method_flags(app, options);
}

void add_render_flags(CLI::App& app, Options& options) {
  add_check_flags(app, options);
  add_look_flags(app, options);
  add_out_flag(app, options);
  add_switch(app, "--mesh", options.mesh, "draw the borders of the patches");
  add_choice(app, "--light", kLightNames,
             "direct: emission and the light of pass 1; indirect: what later passes added; all unless given",
             [&](size_t choice) { options.look.light = static_cast<Light>(choice); });
  add_tone_flag(app, options);
  add_choice(app, "--false-color", kFalseColorNames,
             "numbers as colours with a legend: radiosity, what the last pass added, how often a patch was "
             "halved, why it was split",
             [&](size_t choice) { options.look.false_color = static_cast<FalseColor>(choice); });
  add_switch(app, "--storyboard", options.storyboard,
             "the snapshots side by side, with labels, and below what was added from one to the next");
  add_value(
      app, "--animation", "passes|rounds|shots,...",
      "GIFs of all passes, of the rounds of refinement, of the pictured shots", [&](const std::string& text) {
        bool* const asked[] = {&options.animate_passes, &options.animate_rounds, &options.animate_shots};
        for (const std::string& series : split_list(text))
          *asked[parse_choice("--animation", series, {"passes", "rounds", "shots"})] = true;
      });
  add_choice(app, "--scale", kScaleNames, "of false colours in W/m2; auto unless given",
             [&](size_t choice) { options.look.scale = static_cast<ScaleKind>(choice); });
  add_value(app, "--format", fmt::format("{},...", fmt::join(exporter_formats(), "|")),
            "files to write; png unless given",
            [&](const std::string& text) { options.formats = parse_formats(text); });
  add_value(app, "--report", "FILE", "where the report goes; beside the pictures unless given",
            [&](const std::string& text) {
              if (text.empty()) fail_usage("--report: expected a file");
              options.report = text;
            });
  add_switch(app, "--require-convergence", options.require_convergence,
             "exit code 6 where the passes end before `until` is reached");
}

void add_view_flags(CLI::App& app, Options& options) {
  add_scene(app, options);
  ViewOptions& view = options.view;
  add_value(app, "--from", "ID@U,V", "a polygon and a point of it: 0..1 along its first edge and across",
            [&](const std::string& text) { view = parse_place(text, view); });
  add_value(app, "--pass", "N", "after that pass, 0 is emission alone; the last one unless given",
            [&](const std::string& text) {
              view.pass = static_cast<uint32_t>(parse_count("--pass", text, 0, kPassesFlagMax));
              view.pass_asked = true;
            });
  add_value(app, "--size", "N", "pixels either way; 720 unless given", [&](const std::string& text) {
    view.size = static_cast<uint32_t>(parse_count("--size", text, 1, 1'000'000));
  });
  add_switch(app, "--label", view.label, "write into the picture what it shows");
  add_exposure_flags(app, options);
  add_tone_flag(app, options);
  add_out_flag(app, options);
  add_solver_flags(app, options);
  add_talk_flags(app, options);
}

void add_verify_flags(CLI::App& app, Options& options) {
  add_scene(app, options);
  add_solver_flags(app, options);
  add_talk_flags(app, options);
}

void add_show_flags(CLI::App& app, Options& options) {
  add_common_flags(app, options);
  add_look_flags(app, options);
  add_switch(app, "--effective", options.effective, "the merged settings with their origins");
}

void add_factors_flags(CLI::App& app, Options& options) {
  add_scene(app, options);
  add_run_flags(app, options);
  add_choice(app, "--format", {"csv", "json"}, "csv unless given",
             [&](size_t choice) { options.factors.format = static_cast<FactorFormat>(choice); });
  add_value(app, "--error", "E", "no estimated error of a factor is larger; 0.001 unless given",
            [&](const std::string& text) { options.factors.error = parse_number("--error", text, 1e-6, 1); });
  add_talk_flags(app, options);
}

void add_no_flags(CLI::App&, Options&) {}

void add_completion_flags(CLI::App& app, Options& options) {
  app.add_option("SHELL", options.shell, "bash or zsh")->type_name("")->required();
}

void add_bench_flags(CLI::App& app, Options& options) {
  BenchOptions& bench = options.bench;
  app.add_option("SCENE", bench.scenes, "scene files; seven rooms of scenes/ unless given")->type_name("");
  add_value(app, "--only", "kernels|scenes|loading|growth|threads,...",
            "sections; the first two unless given", [&](const std::string& text) {
              bench.sections = split_list(text);
              for (const std::string& section : bench.sections)
                parse_choice("--only", section, {"kernels", "scenes", "loading", "growth", "threads"});
            });
  add_value(app, "--json", "FILE", "the result as JSON, too", [&](const std::string& text) {
    if (text.empty()) fail_usage("--json: expected a file");
    bench.json = text;
  });
  add_value(app, "--repetitions", "N", "runs of everything; 5 unless given", [&](const std::string& text) {
    bench.repetitions = parse_count("--repetitions", text, 1, 1000);
  });
  add_value(app, "--seconds", "S", "at least so long a repetition of a kernel; 0.2 unless given",
            [&](const std::string& text) { bench.seconds = parse_number("--seconds", text, 0.001, 100); });
  add_value(app, "--threads", "N", "at most so many; all cores unless given",
            [&](const std::string& text) { bench.threads = parse_count("--threads", text, 1, kThreadsMax); });
  add_value(app, "--max-patches", "N", "no measured mesh has more patches", [&](const std::string& text) {
    bench.max_patches = parse_count("--max-patches", text, 1, 1'000'000'000);
  });
  add_value(app, "--max-memory", "BYTES", "growth stops before a mesh that may need more",
            [&](const std::string& text) { bench.max_memory = parse_bytes("--max-memory", text); });
  add_switch(app, "--quiet", options.quiet, "no progress");
}

// A verb: its name, what --help says, and its flags.
struct VerbRow {
  const char* name;
  Verb verb;
  const char* summary;  // in the list of verbs
  const char* help;
  void (*add_flags)(CLI::App&, Options&);
};
constexpr VerbRow kVerbs[] = {
    {"render", Verb::kRender, "solve a scene, write pictures and a report", kRenderHelp, add_render_flags},
    {"view", Verb::kView, "what does a patch see?", kViewHelp, add_view_flags},
    {"check", Verb::kCheck, "what is wrong with a scene, and what would it take?", kCheckHelp,
     add_check_flags},
    {"verify", Verb::kVerify, "does the light come out as the scene expects?", kVerifyHelp, add_verify_flags},
    {"show", Verb::kShow, "which settings hold, and where each comes from", kShowHelp, add_show_flags},
    {"factors", Verb::kFactors, "form factors between the polygons of a scene", kFactorsHelp,
     add_factors_flags},
    {"bench", Verb::kBench, "how fast is it here?", kBenchHelp, add_bench_flags},
    {"schema", Verb::kPrinted, "JSON Schema of the scene language, for editors", kSchemaHelp, add_no_flags},
    {"completion", Verb::kPrinted, "completion for bash and zsh", kCompletionHelp, add_completion_flags},
};

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const VerbRow& row : kVerbs) names.emplace_back(row.name);
  return names;
}

std::vector<std::string> flag_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

// Words that no flag took: the first that looks like a flag is the likely culprit, since its value may have
// been taken for the scene.
[[noreturn]] void fail_extra(const std::vector<std::string>& extras, const CLI::App& verb) {
  const auto flag = std::find_if(extras.begin(), extras.end(),
                                 [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
  if (flag == extras.end())
    fail_usage(fmt::format("'{}' is one argument too many; see patchlight {} --help",
                           escape_text(extras.front()), verb.get_name()));
  const std::string word = flag->substr(0, flag->find('='));
  // One letter is near to every other one.
  fail_usage(fmt::format("{} has no flag '{}'{}; see patchlight {} --help", verb.get_name(),
                         escape_text(word), word.size() > 2 ? hint(word, flag_names(verb)) : "",
                         verb.get_name()));
}

// Flags that only some solvers know are never ignored.
void check_solver_flags(const Options& options) {
  const std::string& solver = options.solver;
  if (solver != "shooting" && !options.shots.empty()) fail_usage("--shots: only --solver shooting has shots");
  if (solver != "shooting" && options.ambient)
    fail_usage("--ambient: only --solver shooting estimates what is unshot");
  const bool has_passes = solver.empty() || solver == solvers()[0].name;
  if (!has_passes && options.passes) fail_usage(fmt::format("--passes: --solver {} has no passes", solver));
  if (!has_passes && (options.snapshots_all || !options.snapshots.empty()))
    fail_usage(fmt::format("--snapshots: --solver {} has no passes{}", solver,
                           solver == "shooting" ? "; --shots asks for pictures after shots" : ""));
}

// Nor are flags of looks that do not go together.
void check_look_flags(const Options& options) {
  const Look& look = options.look;
  const bool colored = look.false_color != FalseColor::kOff,
             of_light = look.false_color == FalseColor::kRadiosity;
  if (colored && look.tone != Tone::kClip) fail_usage("--tone: false colours have none");
  if (colored && !of_light && look.light != Light::kAll)
    fail_usage(fmt::format("--light: false colours of {} know no parts of the light",
                           kFalseColorNames[static_cast<size_t>(look.false_color)]));
  const bool scaled = of_light || look.false_color == FalseColor::kResidual || options.storyboard;
  if (look.scale != ScaleKind::kAuto && !scaled)
    fail_usage("--scale: only radiosity and residual in false colours, and storyboards, have one");
}

// They are read more than once.
void check_bench_scenes(const std::vector<std::string>& scenes) {
  for (const std::string& scene : scenes)
    if (scene.empty() || scene == "-")
      fail_usage(fmt::format("bench: found '{}', expected the path of a scene file", scene));
}

void check_verb(const std::vector<std::string>& arguments) {
  const std::vector<std::string> verbs = verb_names();
  const std::string listed = fmt::format("{}", fmt::join(verbs, ", "));
  if (arguments.empty()) fail_usage(fmt::format("expected a verb: {}; see patchlight --help", listed));
  const std::string& word = arguments.front();
  std::vector<std::string> known = verbs;
  known.insert(known.end(), {"--help", "-h", "--version"});
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  const bool is_flag = word.starts_with('-');
  std::string near = word.size() > 2 ? hint(word, known) : "";
  if (near.empty()) near = is_flag ? "; flags follow a verb: " + listed : "; expected " + listed;
  fail_usage(
      fmt::format("no {} '{}'{}; see patchlight --help", is_flag ? "flag" : "verb", escape_text(word), near));
}

// What shells complete: every verb with its flags, as CLI11 knows them.
std::vector<VerbWords> list_words(const std::vector<CLI::App*>& verbs) {
  std::vector<VerbWords> list;
  for (const CLI::App* verb : verbs) {
    VerbWords words{verb->get_name(), verb->get_description(), {}, {}};
    for (const CLI::Option* option : verb->get_options()) {
      if (option->get_positional()) {
        words.argument = option->get_name();
        continue;
      }
      FlagWords flag{
          {}, option->get_expected_max() > 0 ? option->get_type_name() : "", option->get_description()};
      for (const std::string& name : option->get_snames()) flag.names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) flag.names.push_back("--" + name);
      words.flags.push_back(std::move(flag));
    }
    list.push_back(std::move(words));
  }
  return list;
}

}  // namespace

Options parse_command_line(const std::vector<std::string>& arguments) {
  Options options;
  CLI::App app(kMainHelp);
  app.name("patchlight");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  std::vector<CLI::App*> verbs;
  for (const VerbRow& row : kVerbs) {
    CLI::App* verb = verbs.emplace_back(app.add_subcommand(row.name, row.summary));
    row.add_flags(*verb, options);
    verb->allow_extras();
  }
  check_verb(arguments);
  const auto parsed = [&] {
    return static_cast<size_t>(
        std::find_if(verbs.begin(), verbs.end(), [](const CLI::App* verb) { return verb->parsed(); }) -
        verbs.begin());
  };

  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    // The list of verbs shows the short descriptions, a verb's own help the long one.
    if (const size_t k = parsed(); k < verbs.size()) verbs[k]->description(kVerbs[k].help);
    options.text = app.help();
    return options;
  } catch (const CLI::CallForVersion&) {
    options.text = version_text();
    return options;
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string words = error.what();
    if (words.find("override") != std::string::npos)
      fail_usage(fmt::format("--{}: takes no value", words.substr(0, words.find(' '))));
    fail_usage(fmt::format("{}: expected exactly one value, given once", words.substr(0, words.find(':'))));
  } catch (const CLI::ParseError& error) {
    const size_t k = parsed();
    if (k < verbs.size() && !verbs[k]->remaining().empty()) fail_extra(verbs[k]->remaining(), *verbs[k]);
    fail_usage(escape_text(error.what(), 300));
  }
  const VerbRow& row = kVerbs[parsed()];
  const CLI::App& verb = *verbs[parsed()];
  if (!verb.remaining().empty()) fail_extra(verb.remaining(), verb);
  options.verb = row.verb;
  check_solver_flags(options);
  check_look_flags(options);
  if (row.verb == Verb::kBench) check_bench_scenes(options.bench.scenes);
  const CLI::Option* scene = verb.get_option_no_throw("SCENE");
  if (scene != nullptr && scene->get_required() && options.scene.empty()) fail_usage("expected a scene file");
  if (row.verb == Verb::kView && options.view.polygon.empty())
    fail_usage("view: say from where: --from ID@U,V, such as --from hall.floor@0.5,0.5");
  if (row.verb == Verb::kShow && !options.effective)
    fail_usage("show: say what: --effective shows the merged settings");
  if (row.name == std::string_view("schema")) options.text = format_schema();
  if (row.name == std::string_view("completion"))
    options.text = format_completion(
        static_cast<Shell>(parse_choice("completion", options.shell, {"bash", "zsh"})), list_words(verbs));
  return options;
}

}  // namespace patchlight
