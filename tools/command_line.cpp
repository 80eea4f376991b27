// Command line -> Options; the one door to CLI11. CLI11 splits the words and prints the lists of flags;
// values are read here, because CLI11 takes nan for a number and 010 for eight.
#include "command_line.h"

#include "dsl/diagnostics.h"
#include "dsl/limits.h"
#include "exporters.h"
#include "version.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <functional>

namespace patchlight {
namespace {

constexpr const char* kMainHelp =
    R"(patchlight turns a text scene of polygons into light (radiosity), pass by pass.

Examples:
  patchlight render room.yaml                       pictures after passes 1, 2 and 16 into out/
  patchlight render room.yaml -o lit --format png,exr,csv
  patchlight check room.yaml                        is the scene right, and what would it take?
  patchlight factors room.yaml                      view factors between the polygons of a scene, as CSV
  patchlight render --help                          all flags of render
)";

constexpr const char* kRenderHelp = R"(Solves a scene and writes pictures, and a report, while it goes.

Examples:
  patchlight render room.yaml                       pictures after passes 1, 2 and 16 into out/
  patchlight render room.yaml --passes 4 --snapshots all --size 640x480
  patchlight render room.yaml -D w=8 --set solver.threshold=0.05
  patchlight render room.yaml --camera door --exposure -3.5 --mesh
  patchlight render room.yaml --format exr,csv      numbers instead of pictures
  generate_scene | patchlight render - -o lit       a scene from standard input

Flags are stronger than the scene file. The paths of the files are the lines on standard output.
)";

constexpr const char* kCheckHelp =
    R"(Reads a scene, says what is wrong with it, counts it and forecasts its memory; solves nothing.

Examples:
  patchlight check room.yaml
  patchlight check room.yaml --json                 the messages as a JSON list, for editors
)";

constexpr const char* kFactorsHelp =
    R"(Prints the form factors (view factors) between the polygons of a scene: a row a polygon, with its area, the
factors to all polygons in the order of the scene, and their sum, which is not adjusted.

Examples:
  patchlight factors duct.yaml > duct.csv
  patchlight factors duct.yaml --format json        with an estimated error beside every factor
  patchlight factors duct.yaml --error 1e-4         more rays where something stands between polygons
  patchlight factors duct.yaml -D gap=0.02          a variable of the scene

Factors between polygons with nothing in between are exact (1e-6) and need no rays.
)";

constexpr const char* kBenchHelp =
    R"(Measures this build on this machine: kernels beside bare Embree and bare memory, and whole runs of scenes.

Examples:
  patchlight bench                                  kernels, and the scenes of the folder scenes
  patchlight bench room.yaml --only scenes          whole runs of one scene
  patchlight bench --only growth,threads --json b.json

Every figure is a median with its lowest and highest value. Kernels, growth and threads take the first scene.
)";

[[noreturn]] void fail_usage(const std::string& message) { throw UserError("usage", message); }

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> parts;
  size_t begin = 0;
  while (true) {
    const size_t comma = text.find(',', begin);
    parts.emplace_back(text.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return parts;
    begin = comma + 1;
  }
}

std::vector<std::string> parse_formats(std::string_view text) {
  const std::vector<std::string> known = exporter_formats();
  std::vector<std::string> formats;
  for (const std::string& part : split_list(text)) {
    if (std::find(known.begin(), known.end(), part) == known.end()) {
      const std::string near = did_you_mean(part, known);
      fail_usage(fmt::format("--format: '{}' is not a format{}; known: {}", escape_text(part),
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near),
                             fmt::join(known, ", ")));
    }
    if (std::find(formats.begin(), formats.end(), part) == formats.end()) formats.push_back(part);
  }
  return formats;
}

// The index of `text` in `choices`.
size_t parse_choice(std::string_view flag, const std::string& text, const std::vector<std::string>& choices) {
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end())
    fail_usage(
        fmt::format("{}: found '{}', expected one of {}", flag, escape_text(text), fmt::join(choices, ", ")));
  return static_cast<size_t>(found - choices.begin());
}

using ReadValue = std::function<void(const std::string&)>;

// A flag with one value that `read` understands; CLI11 never sees it as a number.
void add_value(CLI::App& app, const std::string& names, const std::string& placeholder,
               const std::string& help, ReadValue read) {
  app.add_option_function<std::string>(names, std::move(read), help)->type_name(placeholder);
}

// A flag without a value.
void add_switch(CLI::App& app, const std::string& name, bool& value, const std::string& help) {
  app.add_flag(name, value, help)->disable_flag_override();
}

// Which scene, and how to go about it: all verbs that load one scene share these.
void add_scene_flags(CLI::App& app, Options& options) {
  app.add_option("SCENE", options.scene, "a scene file; - reads standard input")->type_name("")->required();
  // One value each time, or they would swallow the scene.
  app.add_option("-D", options.load.definitions, "NAME=VALUE: a variable of the scene, stronger than its let")
      ->type_name("")
      ->allow_extra_args(false);
  app.add_option("--set", options.load.overrides,
                 "PATH=VALUE: any value of the scene, such as solver.rays=64")
      ->type_name("")
      ->allow_extra_args(false);
  add_value(app, "--threads", "N", "threads; all cores unless given", [&](const std::string& text) {
    options.threads = static_cast<uint32_t>(parse_count("--threads", text, 1, kThreadsMax));
  });
  add_value(app, "--seed", "N", "another seed, other samples", [&](const std::string& text) {
    options.seed = parse_count("--seed", text, 0, 4'000'000'000'000'000'000);
  });
  add_switch(app, "--quiet", options.quiet, "no progress and no summary");
  add_switch(app, "--json", options.json,
             "messages as a JSON list on standard output, and nothing else there");
  add_value(
      app, "--color", "WHEN", "auto, always or never; NO_COLOR is honoured", [&](const std::string& text) {
        options.color = static_cast<ColorChoice>(parse_choice("--color", text, {"auto", "always", "never"}));
      });
}

// Flags that change what a solve takes: render and check share them.
void add_solver_flags(CLI::App& app, Options& options) {
  add_scene_flags(app, options);
  add_value(app, "--passes", "N", "at most so many passes (bounces of light)", [&](const std::string& text) {
    options.passes = static_cast<uint32_t>(parse_count("--passes", text, 1, kPassesMax));
  });
  add_value(app, "--snapshots", "LIST", "passes to picture: 1,2,16 or all", [&](const std::string& text) {
    options.snapshots_all = text == "all";
    if (!options.snapshots_all) options.snapshots = parse_snapshots(text);
  });
  add_value(app, "--camera", "NAME", "only this camera of the scene", [&](const std::string& text) {
    if (text.empty()) fail_usage("--camera: expected the name of a camera");
    options.camera = text;
  });
  add_value(app, "--size", "WxH", "pixels of the pictures, such as 960x720",
            [&](const std::string& text) { options.size = parse_size(text); });
  add_value(app, "--rays", "N", "rays a row of form factors; more: less noise, more time",
            [&](const std::string& text) {
              options.rays = static_cast<uint32_t>(parse_count("--rays", text, 1, 1'000'000));
            });
  add_value(app, "--max-patches", "N", "the budget of patches", [&](const std::string& text) {
    options.max_patches = parse_count("--max-patches", text, 1, 1'000'000'000);
  });
}

void add_factor_flags(CLI::App& app, FactorOptions& factors) {
  add_value(app, "--format", "KIND", "csv or json; csv unless given", [&](const std::string& text) {
    factors.format = static_cast<FactorFormat>(parse_choice("--format", text, {"csv", "json"}));
  });
  add_value(app, "--error", "E", "no estimated error of a factor is larger; 0.001 unless given",
            [&](const std::string& text) { factors.error = parse_number("--error", text, 1e-6, 1); });
  add_value(app, "--max-memory", "BYTES", "larger matrices are refused", [&](const std::string& text) {
    factors.max_memory = parse_count("--max-memory", text, 1, ~uint64_t{0});
  });
}

void add_render_flags(CLI::App& app, Options& options) {
  add_value(app, "-o", "DIR", "where the files go; out unless given", [&](const std::string& text) {
    if (text.empty()) fail_usage("-o: expected a directory");
    options.out = text;
  });
  add_value(app, "--shading", "KIND", "smooth, or flat: one colour a patch", [&](const std::string& text) {
    options.shading = static_cast<Shading>(parse_choice("--shading", text, {"smooth", "flat"}));
  });
  add_switch(app, "--mesh", options.mesh, "draw the borders of the patches");
  add_value(app, "--exposure", "EV", "auto, or EV: the picture shows B * 2^EV", [&](const std::string& text) {
    options.exposure_auto = text == "auto";
    if (!options.exposure_auto) options.exposure_ev = parse_number("--exposure", text, -100, 100);
  });
  add_value(app, "--format", "LIST",
            fmt::format("files to write, of {}; png unless given", fmt::join(exporter_formats(), ",")),
            [&](const std::string& text) { options.formats = parse_formats(text); });
  add_value(app, "--report", "FILE", "where the report goes; beside the pictures unless given",
            [&](const std::string& text) {
              if (text.empty()) fail_usage("--report: expected a file");
              options.report = text;
            });
}

void add_bench_flags(CLI::App& app, Options& options) {
  BenchOptions& bench = options.bench;
  app.add_option("SCENE", bench.scenes, "scene files; scenes/*.yaml unless given")->type_name("");
  add_value(app, "--only", "LIST", "sections, of kernels,scenes,growth,threads; the first two unless given",
            [&](const std::string& text) {
              bench.sections = split_list(text);
              for (const std::string& section : bench.sections)
                parse_choice("--only", section, {"kernels", "scenes", "growth", "threads"});
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
            [&](const std::string& text) {
              bench.max_memory = parse_count("--max-memory", text, 1, ~uint64_t{0});
            });
  add_switch(app, "--quiet", options.quiet, "no progress");
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
    fail_usage(fmt::format("'{}' is one argument too many; expected one scene", escape_text(extras.front())));
  const std::string word = flag->substr(0, flag->find('='));
  const std::string near = did_you_mean(word, flag_names(verb));
  fail_usage(fmt::format("{} has no flag '{}'{}; see patchlight {} --help", verb.get_name(),
                         escape_text(word), near.empty() ? "" : fmt::format("; did you mean '{}'?", near),
                         verb.get_name()));
}

// They are read more than once.
void check_bench_scenes(const std::vector<std::string>& scenes) {
  for (const std::string& scene : scenes)
    if (scene.empty() || scene == "-")
      fail_usage(fmt::format("bench: found '{}', expected the path of a scene file", scene));
}

void check_verb(const std::vector<std::string>& arguments, const std::vector<std::string>& verbs) {
  if (arguments.empty())
    fail_usage(fmt::format("expected a verb: {}; see patchlight --help", fmt::join(verbs, " or ")));
  const std::string& word = arguments.front();
  std::vector<std::string> known = verbs;
  known.insert(known.end(), {"--help", "-h", "--version"});
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  const std::string near = did_you_mean(word, known);
  fail_usage(fmt::format("no {} '{}'{}; see patchlight --help", word[0] == '-' ? "flag" : "verb",
                         escape_text(word),
                         near.empty() ? fmt::format("; expected {}", fmt::join(verbs, " or "))
                                      : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace

uint64_t parse_count(std::string_view flag, std::string_view text, uint64_t low, uint64_t high) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole =
      !text.empty() && end == text.data() + text.size() && error != std::errc::invalid_argument;
  const bool leading_zero = text.size() > 1 && text[0] == '0';
  if (!whole || leading_zero)
    fail_usage(fmt::format("{}: found '{}', expected a whole number", flag, escape_text(text)));
  if (error == std::errc::result_out_of_range || value < low || value > high)
    fail_usage(fmt::format("{}: {} is outside {} to {}", flag, escape_text(text), low, high));
  return value;
}

double parse_number(std::string_view flag, std::string_view text, double low, double high) {
  // from_chars would also take inf, nan and 010.
  std::string_view digits = text;
  if (!digits.empty() && digits[0] == '-') digits.remove_prefix(1);
  const bool starts_well = !digits.empty() && (digits[0] == '.' || (digits[0] >= '0' && digits[0] <= '9'));
  const bool leading_zero = digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!starts_well || leading_zero || end != text.data() + text.size() ||
      error == std::errc::invalid_argument)
    fail_usage(fmt::format("{}: found '{}', expected a number", flag, escape_text(text)));
  if (error != std::errc{} || !(value >= low && value <= high))
    fail_usage(fmt::format("{}: {} is outside {} to {}", flag, escape_text(text), low, high));
  return value;
}

std::vector<uint32_t> parse_snapshots(std::string_view text) {
  std::vector<uint32_t> passes;
  for (const std::string& part : split_list(text))
    passes.push_back(static_cast<uint32_t>(parse_count("--snapshots", part, 1, kPassesMax)));
  std::sort(passes.begin(), passes.end());
  passes.erase(std::unique(passes.begin(), passes.end()), passes.end());
  return passes;
}

std::array<uint32_t, 2> parse_size(std::string_view text) {
  const size_t cross = text.find('x');
  if (cross == std::string_view::npos)
    fail_usage(fmt::format("--size: found '{}', expected WIDTHxHEIGHT, such as 960x720", escape_text(text)));
  const uint64_t width = parse_count("--size", text.substr(0, cross), 1, ~uint32_t{0});
  const uint64_t height = parse_count("--size", text.substr(cross + 1), 1, ~uint32_t{0});
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

Options parse_command_line(const std::vector<std::string>& arguments) {
  Options options;
  CLI::App app(kMainHelp);
  app.name("patchlight");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  CLI::App* render = app.add_subcommand("render", "solve a scene, write pictures and a report");
  add_solver_flags(*render, options);
  add_render_flags(*render, options);
  CLI::App* check = app.add_subcommand("check", "what is wrong with a scene, and what would it take?");
  add_solver_flags(*check, options);
  CLI::App* factors = app.add_subcommand("factors", "form factors between the polygons of a scene");
  add_scene_flags(*factors, options);
  add_factor_flags(*factors, options.factors);
  CLI::App* bench = app.add_subcommand("bench", "how fast is it here?");
  add_bench_flags(*bench, options);
  const std::vector<CLI::App*> verbs = {render, check, factors, bench};
  std::vector<std::string> names;
  for (CLI::App* verb : verbs) {
    verb->allow_extras();
    names.push_back(verb->get_name());
  }
  check_verb(arguments, names);

  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    // The list of verbs shows the short descriptions, a verb's own help the long one.
    render->description(kRenderHelp);
    check->description(kCheckHelp);
    factors->description(kFactorsHelp);
    bench->description(kBenchHelp);
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
    for (CLI::App* verb : {render, check, factors})
      if (verb->parsed() && !verb->remaining().empty()) fail_extra(verb->remaining(), *verb);
    fail_usage(escape_text(error.what(), 300));
  }
  for (CLI::App* verb : verbs)
    if (verb->parsed() && !verb->remaining().empty()) fail_extra(verb->remaining(), *verb);
  if (bench->parsed()) {
    check_bench_scenes(options.bench.scenes);
    options.verb = Verb::kBench;
    return options;
  }
  if (options.scene.empty()) fail_usage("expected a scene file");
  options.verb = render->parsed() ? Verb::kRender : check->parsed() ? Verb::kCheck : Verb::kFactors;
  return options;
}

}  // namespace patchlight
