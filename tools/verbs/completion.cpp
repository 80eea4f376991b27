// The verb completion: verbs and flags to a script that makes a shell complete them.
#include "tools/verbs/completion.h"

#include "tools/base/files.h"
#include "tools/base/flag_values.h"
#include "tools/verbs/verbs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr const char* kHelp =
    R"(Prints what makes a shell complete verbs, flags and their values.

Examples:
  source <(patchlight completion bash)              bash: here and now; in ~/.bashrc: always
  patchlight completion zsh > ~/.zfunc/_patchlight  zsh: in a folder of $fpath, before compinit
)";

struct CompletionOptions {
  Shell shell = Shell::kBash;
  std::string word;  // as it was given
};

bool has_choices(const std::string& value) { return value.find('|') != std::string::npos; }

// "a|b|c,..." -> "a b c".
std::string choices_of(std::string value) {
  value = value.substr(0, value.find(','));
  std::replace(value.begin(), value.end(), '|', ' ');
  return value;
}

bool is_list(const std::string& value) { return value.ends_with(",..."); }

// What bash offers behind a flag, as a command; empty: nothing.
std::string bash_value(const std::string& value) {
  if (has_choices(value))
    return fmt::format("_patchlight_{} '{}'", is_list(value) ? "list" : "words", choices_of(value));
  if (value == "FILE") return "_patchlight_files -f";
  if (value == "DIR") return "_patchlight_files -d";
  return {};
}

// One case a flag that takes a value; those that have nothing to offer share one.
std::string bash_flags(const VerbWords& verb) {
  std::string text;
  std::vector<std::string> free;
  for (const Flag& flag : verb.usage.flags) {
    if (flag.value.empty()) continue;
    const std::string offer = bash_value(flag.value);
    if (offer.empty())
      free.push_back(flag.name);
    else
      text += fmt::format("        {}) {}; return ;;\n", flag.name, offer);
  }
  if (!free.empty()) text += fmt::format("        {}) return ;;\n", fmt::join(free, "|"));
  return text;
}

std::string format_bash(std::span<const VerbWords> verbs) {
  std::vector<std::string> names;
  std::string cases;
  for (const VerbWords& verb : verbs) {
    names.push_back(verb.name);
    std::vector<std::string> flags;
    for (const Flag& flag : verb.usage.flags) flags.push_back(flag.name);
    const Argument& argument = verb.usage.argument;
    const std::string choices = choices_of(argument.value);
    cases += fmt::format("    {})\n      case $before in\n{}      esac\n", verb.name, bash_flags(verb));
    cases += fmt::format("      if [[ $word == -* ]]; then _patchlight_words '{}'; else {}; fi ;;\n",
                         fmt::join(flags, " "),
                         !choices.empty()        ? fmt::format("_patchlight_words '{}'", choices)
                         : argument.name.empty() ? ":"
                                                 : "_patchlight_files -f");
  }
  return fmt::format(R"(# patchlight: completion for bash, by `patchlight completion bash`.
_patchlight_words() {{ COMPREPLY=($(compgen -W "$1" -- "$word")); }}
_patchlight_list() {{
  local head=
  [[ $word == *,* ]] && head=${{word%,*}},
  COMPREPLY=($(compgen -P "$head" -W "$1" -- "${{word##*,}}"))
}}
_patchlight_files() {{
  local IFS=$'\n'
  compopt -o filenames 2>/dev/null
  COMPREPLY=($(compgen "$1" -- "$word"))
}}
_patchlight() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} IFS=$' \t\n'
  COMPREPLY=()
  # --flag=value comes as three words.
  if [[ $word == = ]]; then word=; elif [[ $before == = ]]; then before=${{COMP_WORDS[COMP_CWORD - 2]}}; fi
  if ((COMP_CWORD == 1)); then
    _patchlight_words '{} --help --version'
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
}}
complete -F _patchlight patchlight
)",
                     fmt::join(names, " "), cases);
}

// Text inside of '...[...]' of zsh's _arguments.
std::string zsh_escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_value(const std::string& value) {
  if (is_list(value)) return fmt::format("_values -s , word {}", choices_of(value));
  if (has_choices(value)) return fmt::format("({})", choices_of(value));
  if (value == "FILE") return "_files";
  if (value == "DIR") return "_files -/";
  return "";
}

std::string format_zsh(std::span<const VerbWords> verbs) {
  std::string names, cases;
  for (const VerbWords& verb : verbs) {
    names += fmt::format("    '{}:{}'\n", verb.name, zsh_escape(verb.help));
    cases += fmt::format("    {})\n      _arguments", verb.name);
    for (const Flag& flag : verb.usage.flags)
      cases += fmt::format(
          " \\\n        '*{}[{}]{}'", flag.name, zsh_escape(flag.help),
          flag.value.empty() ? "" : fmt::format(":{}:{}", zsh_escape(flag.value), zsh_value(flag.value)));
    const Argument& argument = verb.usage.argument;
    const std::string choices = choices_of(argument.value);
    if (!argument.name.empty())
      cases += fmt::format(" \\\n        '*:{}:{}'", argument.name,
                           choices.empty() ? "_files" : fmt::format("({})", choices));
    cases += " ;;\n";
  }
  return fmt::format(R"(#compdef patchlight
# patchlight: completion for zsh, by `patchlight completion zsh`.
_patchlight() {{
  local -a verbs=(
{}  )
  if ((CURRENT == 2)); then
    _describe 'verb' verbs
    _arguments '--help[what it does]' '--version[versions]'
    return
  fi
  local verb=$words[2]
  shift words
  ((CURRENT--))
  case $verb in
{}  esac
}}
if [[ $funcstack[1] == _patchlight ]]; then
  _patchlight "$@"
else
  compdef _patchlight patchlight
fi
)",
                     names, cases);
}

}  // namespace

std::string format_completion(Shell shell, std::span<const VerbWords> verbs) {
  return shell == Shell::kBash ? format_bash(verbs) : format_zsh(verbs);
}

std::vector<VerbWords> list_words() {
  std::vector<VerbWords> list;
  for (const Verb& verb : verbs()) {
    Options options;  // nothing is read into it
    VerbWords words{std::string(verb.name), std::string(verb.summary), {}};
    // CLI11 gives these two to every verb.
    for (const char* name : {"-h", "--help"})
      words.usage.flags.push_back({name, "", "Print this help message and exit"});
    verb.describe(words.usage, options);
    list.push_back(std::move(words));
  }
  return list;
}

void describe_completion(Usage& usage, Options& options) {
  CompletionOptions& own = options.own.emplace<CompletionOptions>();
  usage.help = kHelp;
  usage.argument = {.name = "SHELL", .value = "bash|zsh", .help = "bash or zsh", .word = &own.word};
  usage.checks.push_back([&own] {
    own.shell = static_cast<Shell>(parse_choice("completion", own.word, {"bash", "zsh"}));
  });
}

int print_completion(const Options& options, Talk&) {
  print_result(format_completion(get_own<CompletionOptions>(options).shell, list_words()));
  return 0;
}

}  // namespace patchlight
