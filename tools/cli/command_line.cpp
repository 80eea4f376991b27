// Command line -> a verb and Options; the one door to CLI11. CLI11 splits the words and prints the lists of
// flags; the flags' own functions read values, because CLI11 takes nan for a number and 010 for eight.
#include "tools/cli/command_line.h"

#include "dsl/report/diagnostics.h"
#include "tools/base/flag_values.h"
#include "tools/base/version.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr const char* kMainHelp =
    R"(patchlight turns a text scene of polygons into light (radiosity), pass by pass.

Examples:
  patchlight render room.yaml                       pictures after passes 1, 2 and 16 into out/
  patchlight render room.yaml -o lit --format png,exr,csv
  patchlight view room.yaml --from hall.floor@0.5,0.5     what a patch sees
  patchlight check room.yaml                        is the scene right, and what would it take?
  patchlight verify room.yaml                       does the light come out as the scene expects?
  patchlight show room.yaml --effective             which settings hold, and where each comes from
  patchlight factors room.yaml                      view factors between the polygons of a scene, as CSV
  patchlight render --help                          all flags of render
)";

// A verb as the words are read: what they set must stay in its place.
struct Reading {
  Options options;
  Usage usage;
  CLI::App* app = nullptr;
};

void add_flag(CLI::App& app, const Flag& flag) {
  CLI::Option* option = nullptr;
  if (flag.on != nullptr)
    option = app.add_flag(flag.name, *flag.on, flag.help)->disable_flag_override();
  else if (flag.list != nullptr)  // One value each time, or they would swallow the scene.
    option = app.add_option(flag.name, *flag.list, flag.help)->type_name(flag.value)->allow_extra_args(false);
  else
    option = app.add_option_function<std::string>(flag.name, flag.read, flag.help)->type_name(flag.value);
  if (!flag.group.empty()) option->group(flag.group);
}

void add_argument(CLI::App& app, const Argument& argument) {
  if (argument.word != nullptr)
    app.add_option(argument.name, *argument.word, argument.help)->type_name("")->required();
  else if (argument.list != nullptr)
    app.add_option(argument.name, *argument.list, argument.help)->type_name("");
}

void start_reading(Reading& reading, const Verb& verb, CLI::App& program) {
  verb.describe(reading.usage, reading.options);
  reading.app = program.add_subcommand(std::string(verb.name), std::string(verb.summary));
  add_argument(*reading.app, reading.usage.argument);
  for (const Flag& flag : reading.usage.flags) add_flag(*reading.app, flag);
  reading.app->allow_extras();
}

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) names.emplace_back(verb.name);
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

}  // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
  CLI::App app(kMainHelp);
  app.name("patchlight");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  std::vector<Reading> readings(verbs().size());
  for (size_t k = 0; k < readings.size(); ++k) start_reading(readings[k], verbs()[k], app);
  check_verb(arguments);
  const auto parsed = [&] {
    return static_cast<size_t>(std::find_if(readings.begin(), readings.end(),
                                            [](const Reading& reading) { return reading.app->parsed(); }) -
                               readings.begin());
  };

  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    // The list of verbs shows the short descriptions, a verb's own help the long one.
    if (const size_t k = parsed(); k < readings.size()) readings[k].app->description(readings[k].usage.help);
    return {.text = app.help()};
  } catch (const CLI::CallForVersion&) {
    return {.text = version_text()};
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string words = error.what();
    if (words.find("override") != std::string::npos)
      fail_usage(fmt::format("--{}: takes no value", words.substr(0, words.find(' '))));
    fail_usage(fmt::format("{}: expected exactly one value, given once", words.substr(0, words.find(':'))));
  } catch (const CLI::ParseError& error) {
    const size_t k = parsed();
    if (k < readings.size() && !readings[k].app->remaining().empty())
      fail_extra(readings[k].app->remaining(), *readings[k].app);
    fail_usage(escape_text(error.what(), 300));
  }
  const size_t k = parsed();
  Reading& reading = readings[k];
  if (!reading.app->remaining().empty()) fail_extra(reading.app->remaining(), *reading.app);
  for (const auto& check : reading.usage.checks) check();
  return {.verb = &verbs()[k], .options = std::move(reading.options)};
}

bool wants_json(const std::vector<std::string>& arguments) {
  if (std::find(arguments.begin(), arguments.end(), "--json") == arguments.end()) return false;
  const auto verb = std::find_if(verbs().begin(), verbs().end(),
                                 [&](const Verb& row) { return row.name == arguments.front(); });
  if (verb == verbs().end()) return true;
  Options options;
  Usage usage;
  verb->describe(usage, options);
  // Where it has a value, it names a file.
  return std::none_of(usage.flags.begin(), usage.flags.end(),
                      [](const Flag& flag) { return flag.name == "--json" && !flag.value.empty(); });
}

}  // namespace patchlight
