// Words of the command line: what they mean, and what is said of mistakes.
#include "tools/cli/command_line.h"

#include "dsl/report/diagnostics.h"
#include "tests/tools/mistakes.h"
#include "tools/base/flag_values.h"
#include "tools/image/false_colors.h"
#include "tools/image/tone.h"
#include "tools/render/render.h"
#include "tools/verbs/factors.h"
#include "tools/verbs/view.h"

#include <doctest/doctest.h>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("render with all of its flags") {
  const Options options = parse_options({"render",    "-o",          "lit",           "--passes",
                                         "8",         "--snapshots", "4,1,4",         "--camera",
                                         "door",      "--size",      "64x48",         "--mesh",
                                         "--shading", "flat",        "--exposure",    "-3.5",
                                         "--rays",    "32",          "--threads",     "3",
                                         "--seed",    "7",           "--max-patches", "5000",
                                         "--format",  "exr,csv,exr", "--report",      "r.json",
                                         "--quiet",   "--color",     "never",         "--form-factors",
                                         "recompute", "--light",     "indirect",      "room.yaml"});
  CHECK(options.scene == "room.yaml");
  CHECK(options.out == "lit");
  CHECK(options.passes == 8u);
  CHECK(options.snapshots == std::vector<uint32_t>{1, 4});
  CHECK(options.camera == "door");
  CHECK((*options.size)[0] == 64);
  CHECK((*options.size)[1] == 48);
  CHECK(options.mesh);
  CHECK((options.shading == Shading::kFlat));
  CHECK((options.look.light == Light::kIndirect));
  CHECK(options.exposure_ev == -3.5);
  CHECK(options.rays == 32u);
  CHECK(options.threads == 3u);
  CHECK(options.seed == 7u);
  CHECK(options.max_patches == 5000u);
  CHECK(options.formats == std::vector<std::string>{"exr", "csv"});
  CHECK(get_own<RenderOptions>(options).report == "r.json");
  CHECK(options.keep_rows == false);
  CHECK(options.quiet);
  CHECK((options.color == ColorChoice::kNever));
}

TEST_CASE("factors with all of its flags, and with none") {
  const Options options =
      parse_options({"factors", "room.yaml", "--format", "json", "--error", "1e-4", "--max-memory", "1000000",
                     "--threads", "2", "--seed", "5", "-D", "w=8", "--quiet"});
  CHECK(options.scene == "room.yaml");
  const FactorOptions& own = get_own<FactorOptions>(options);
  CHECK((own.format == FactorFormat::kJson));
  CHECK(own.error == 1e-4);
  CHECK(options.max_memory == 1000000u);
  CHECK(options.threads == 2u);
  CHECK(options.seed == 5u);
  CHECK(options.load.definitions == std::vector<std::string>{"w=8"});
  CHECK(options.quiet);
  const Options plain = parse_options({"factors", "room.yaml"});
  const FactorOptions& usual = get_own<FactorOptions>(plain);
  CHECK((usual.format == FactorFormat::kCsv));
  CHECK(usual.error == 1e-3);
  CHECK(find_mistake({"factors"}) != "");
  CHECK(has(find_mistake({"factors", "a.yaml", "--error", "nan"}), "--error"));
  CHECK(has(find_mistake({"factors", "a.yaml", "--format", "yaml"}), "csv"));
  CHECK(has(find_mistake({"factors", "a.yaml", "--rays", "5"}), "factors has no flag '--rays'"));
  CHECK(has(find_mistake({"factor", "a.yaml"}), "did you mean 'factors'?"));
}

TEST_CASE("what is not asked for is left to the scene") {
  const Options options = parse_options({"render", "-"});
  CHECK(options.scene == "-");
  CHECK(options.out == "out");
  CHECK(!options.passes);
  CHECK(options.snapshots.empty());
  CHECK(!options.snapshots_all);
  CHECK(!options.exposure_ev);
  CHECK(!options.exposure_auto);
  CHECK(options.formats == std::vector<std::string>{"png"});
}

TEST_CASE("-D and --set may be given often, each with one value") {
  const Options options =
      parse_options({"check", "-D", "w=8", "a.yaml", "-D", "h=-2", "--set", "solver.rays=9"});
  CHECK(options.scene == "a.yaml");
  CHECK(options.load.definitions == std::vector<std::string>{"w=8", "h=-2"});
  CHECK(options.load.overrides == std::vector<std::string>{"solver.rays=9"});
}

TEST_CASE("words in place of numbers: --snapshots all, --exposure auto") {
  const Options options = parse_options({"render", "a.yaml", "--snapshots=all", "--exposure=auto"});
  CHECK(options.snapshots_all);
  CHECK(options.exposure_auto);
}

TEST_CASE("the command line may ask for more passes than a scene file may") {
  const Options options = parse_options({"check", "a.yaml", "--passes", "20000", "--snapshots", "15000"});
  CHECK(options.passes == 20000u);
  CHECK(options.snapshots == std::vector<uint32_t>{15000});
}

TEST_CASE("mistakes on the command line are usage errors that say what was meant") {
  struct Mistake {
    std::vector<std::string> words;
    const char* said;
  };
  const std::vector<Mistake> mistakes = {
      {{}, "expected a verb"},
      {{"rendr", "a.yaml"}, "did you mean 'render'?"},
      {{"benhc"}, "did you mean 'bench'?"},
      {{"--mesh"}, "no flag '--mesh'"},
      {{"render"}, "SCENE is required"},
      {{"render", ""}, "expected a scene file"},
      {{"render", "a.yaml", "b.yaml"}, "'b.yaml' is one argument too many"},
      {{"render", "--pases", "3", "a.yaml"}, "no flag '--pases'; did you mean '--passes'?"},
      {{"render", "a.yaml", "--resume"}, "no flag '--resume'"},
      {{"check", "a.yaml", "--mesh"}, "check has no flag '--mesh'"},
      {{"render", "a.yaml", "--passes"}, "--passes: expected exactly one value"},
      {{"render", "a.yaml", "--passes", "1", "--passes", "2"}, "--passes: expected exactly one value"},
      {{"render", "a.yaml", "--mesh=3"}, "--mesh: takes no value"},
      {{"render", "a.yaml", "--passes", "0"}, "0 is outside 1 to 1000000"},
      {{"render", "a.yaml", "--passes", "nan"}, "expected a whole number"},
      {{"render", "a.yaml", "--passes", "010"}, "expected a whole number"},
      {{"render", "a.yaml", "--passes", "1e2"}, "expected a whole number"},
      {{"render", "a.yaml", "--passes", "-1"}, "expected a whole number"},
      {{"render", "a.yaml", "--passes", "99999999999999999999999"}, "outside"},
      {{"render", "a.yaml", "--threads", "0"}, "0 is outside 1 to 1024"},
      {{"render", "a.yaml", "--threads", "1000000"}, "outside 1 to 1024"},
      {{"render", "a.yaml", "--exposure", "nan"}, "expected a number"},
      {{"render", "a.yaml", "--exposure", "inf"}, "expected a number"},
      {{"render", "a.yaml", "--exposure", "1e999"}, "outside -100 to 100"},
      {{"render", "a.yaml", "--exposure", "3,5"}, "expected a number"},
      {{"render", "a.yaml", "--snapshots", "1,,2"}, "found '', expected a whole number"},
      {{"render", "a.yaml", "--snapshots", "0"}, "0 is outside"},
      {{"render", "a.yaml", "--size", "640"}, "expected WIDTHxHEIGHT"},
      {{"render", "a.yaml", "--size", "640x0"}, "0 is outside"},
      {{"render", "a.yaml", "--shading", "round"}, "expected one of smooth, flat"},
      {{"render", "a.yaml", "--format", "pgn"}, "did you mean 'png'?"},
      {{"render", "a.yaml", "--color", "often"}, "expected one of auto, always, never"},
      {{"render", "a.yaml", "--shading", "smoth"}, "did you mean 'smooth'?"},
      {{"verifi", "a.yaml"}, "did you mean 'verify'?"},
      {{"verify", "a.yaml", "-o", "out"}, "verify has no flag '-o'"},
      {{"show", "a.yaml"}, "--effective"},
      {{"show", "a.yaml", "--efective"}, "did you mean '--effective'?"},
      {{"schema", "a.yaml"}, "'a.yaml' is one argument too many"},
      {{"schema", "--json"}, "schema has no flag '--json'"},
      {{"-D", "w=1", "render", "a.yaml"}, "flags follow a verb"},
      {{"--verison"}, "did you mean '--version'?"},
      {{"render", "a.yaml", "-x"}, "render has no flag '-x'; see"},
      {{"check", "a.yaml", "--max-polgons", "3"}, "did you mean '--max-polygons'?"},
      {{"check", "a.yaml", "--max-polygons", "x"}, "--max-polygons: found 'x', expected a whole number"},
      {{"check", "a.yaml", "--max-nesting", "257"}, "--max-nesting: 257 is outside 1 to 256"},
      {{"completion"}, "SHELL is required"},
      {{"completion", "bsh"}, "did you mean 'bash'?"},
      {{"render", "a.yaml", "--max-memory", "lots"}, "expected a whole number"},
      {{"render", "a.yaml", "--max-memory", "0"}, "0 is outside"},
      {{"render", "a.yaml", "--max-memory", "99999999999999999999T"}, "outside"},
      {{"render", "a.yaml", "-o", ""}, "expected a directory"},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string said = find_mistake(mistake.words);
    CAPTURE(said);
    CHECK(said.starts_with("usage: "));
    CHECK_MESSAGE(has(said, mistake.said), mistake.said);
  }
}

TEST_CASE("every limit has a flag of render and of check, with a range") {
  const Limits usual;
  for (const char* verb : {"render", "check"}) {
    const std::string help = parse_command_line({verb, "--help"}).text;
    for (const LimitRow& row : kLimitRows) {
      const std::string flag(row.flag), usual_text = std::to_string(usual.*row.limit);
      CAPTURE(flag);
      CHECK(has(help, flag));
      CHECK(has(help, usual_text + " unless given"));
      CHECK(row.highest > usual.*row.limit);
      const Options options = parse_options({verb, "a.yaml", flag, std::to_string(row.highest)});
      CHECK(options.load.limits.*row.limit == row.highest);
      CHECK(has(find_mistake({verb, "a.yaml", flag, std::to_string(row.highest + 1)}), "is outside 1 to"));
      CHECK(has(find_mistake({verb, "a.yaml", flag, "0"}), "is outside 1 to"));
    }
  }
  const Options options =
      parse_options({"check", "a.yaml", "--max-patches", "3000000", "--max-memory", "5000"});
  CHECK(options.load.limits.starting_patches == 3'000'000);
  CHECK(options.max_memory == 5000u);
}

TEST_CASE("text from the command line is printed escaped") {
  const std::string said = find_mistake({"render", "a.yaml", "--passes", "\x1b[31m"});
  CHECK(!has(said, "\x1b"));
}

TEST_CASE("help leads with examples") {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"},
                                                {"render", "--help"},
                                                {"check", "-h"},
                                                {"verify", "--help"},
                                                {"show", "--help"},
                                                {"bench", "--help"},
                                                {"schema", "--help"},
                                                {"completion", "--help"}}) {
    const Command command = parse_command_line(words);
    CHECK(command.verb == nullptr);
    CHECK(command.text.find("Examples:") < command.text.find("Usage:"));
  }
  CHECK(has(parse_command_line({"--version"}).text, "patchlight "));
}

TEST_CASE("numbers are read whole") {
  CHECK(parse_number("--exposure", "-.5", -1, 1) == -0.5);
  CHECK(parse_number("--exposure", "0.25", -1, 1) == 0.25);
  CHECK(parse_number("--exposure", "0", -1, 1) == 0);
  CHECK(parse_number("--exposure", "1e-2", -1, 1) == 0.01);
  for (const char* text : {"", "-", "+1", " 1", "1 ", "0x1", "1.5m", "01"})
    CHECK_THROWS_AS(parse_number("--exposure", text, -10, 10), UserError);
  CHECK(parse_bytes("--max-memory", "123") == 123);
  CHECK(parse_bytes("--max-memory", "5k") == 5000);
  CHECK(parse_bytes("--max-memory", "2G") == 2'000'000'000);
  CHECK(parse_bytes("--max-memory", "18446744T") == 18'446'744'000'000'000'000u);
  CHECK_THROWS_AS(parse_bytes("--max-memory", "18446745T"), UserError);
  CHECK_THROWS_AS(parse_bytes("--max-memory", "G"), UserError);
  CHECK(parse_count("--seed", "0", 0, 10) == 0);
  CHECK(parse_count("--seed", "18446744073709551615", 0, ~uint64_t{0}) == ~uint64_t{0});
  CHECK_THROWS_AS(parse_count("--seed", "18446744073709551616", 0, ~uint64_t{0}), UserError);
}

TEST_CASE("flags of looks and of pictures of the whole run") {
  const Options options = parse_options({"render", "a.yaml", "--false-color", "residual", "--scale", "log",
                                         "--storyboard", "--animation", "rounds,passes"});
  CHECK((parse_options({"render", "a.yaml", "--tone", "filmic"}).look.tone == find_tone("filmic")));
  CHECK((options.look.false_color == find_false_color("residual")));
  CHECK((options.look.scale == ScaleKind::kLog));
  CHECK(options.storyboard);
  CHECK(options.animate_passes);
  CHECK(options.animate_rounds);
  CHECK(!parse_options({"render", "a.yaml", "--animation", "rounds"}).animate_passes);
  CHECK(has(find_mistake({"render", "a.yaml", "--animation", "pases"}), "did you mean 'passes'?"));
  CHECK(has(find_mistake({"render", "a.yaml", "--false-color", "levels"}), "did you mean 'level'?"));
}

TEST_CASE("looks that do not go together are told") {
  const std::vector<std::string> render = {"render", "a.yaml"};
  const auto mistake = [&](std::vector<std::string> words) {
    words.insert(words.begin(), render.begin(), render.end());
    return find_mistake(words);
  };
  CHECK(has(mistake({"--tone", "filmic", "--false-color", "radiosity"}), "--tone"));
  CHECK(has(mistake({"--light", "direct", "--false-color", "level"}), "--light"));
  CHECK(has(mistake({"--scale", "log"}), "--scale"));
  CHECK(has(mistake({"--scale", "log", "--false-color", "reason"}), "--scale"));
  CHECK(mistake({"--scale", "log", "--storyboard"}).empty());
  CHECK(mistake({"--light", "direct", "--false-color", "radiosity"}).empty());
  CHECK(has(find_mistake({"show", "a.yaml", "--effective", "--tone", "filmic"}), "--tone"));
}

TEST_CASE("view: from where, and after which pass") {
  const Options options = parse_options({"view", "a.yaml", "--from", "lamps[0,1,0]@0.25,1", "--pass", "0",
                                         "--size", "300", "--label", "--tone", "filmic", "-o", "lit"});
  const ViewOptions& view = get_own<ViewOptions>(options);
  CHECK(view.polygon == "lamps[0,1,0]");
  CHECK(view.u == 0.25);
  CHECK(view.v == 1);
  CHECK(view.pass_asked);
  CHECK(view.pass == 0);
  CHECK(view.size == 300);
  CHECK(view.label);
  CHECK(options.out == "lit");
  CHECK(has(find_mistake({"view", "a.yaml"}), "--from"));
  for (const char* from : {"floor", "floor@0.5", "@0.5,0.5", "floor@0.5,2", "floor@a,b", "floor@0.1,0.2,0.3"})
    CHECK_MESSAGE(has(find_mistake({"view", "a.yaml", "--from", from}), "usage: --from"), from);
}
