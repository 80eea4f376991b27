// Completion: what the command line knows is what shells offer.
#include "tools/verbs/completion.h"

#include "tests/folder.h"
#include "tools/cli/command_line.h"

#include <doctest/doctest.h>

#include <cstdlib>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

// What bash offers for the words of a line, the last one being typed.
std::string complete_in_bash(const std::string& words) {
  const Folder folder;
  write_bytes(folder / "completion.bash", format_completion(Shell::kBash, list_words()));
  write_bytes(folder / "ask.bash",
              "source '" + folder / "completion.bash" + "'\ncd '" PATCHLIGHT_SOURCE_DIR "'\nCOMP_WORDS=(" +
                  words +
                  ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_patchlight\necho \"${COMPREPLY[*]}\"\n");
  const std::string command = "bash '" + folder / "ask.bash" + "' > '" + folder / "out" + "' 2>&1";
  CHECK(std::system(command.c_str()) == 0);
  return read_bytes(folder / "out");
}

}  // namespace

TEST_CASE("bash completes verbs, flags, choices, lists and files") {
  CHECK(complete_in_bash("patchlight ver") == "verify\n");
  CHECK(complete_in_bash("patchlight render --sha") == "--shading\n");
  CHECK(complete_in_bash("patchlight render --shading ''") == "smooth flat\n");
  CHECK(complete_in_bash("patchlight render --color = al") == "always\n");
  CHECK(complete_in_bash("patchlight render --format png,e") == "png,exr\n");
  CHECK(complete_in_bash("patchlight render --passes ''") == "\n");
  CHECK(complete_in_bash("patchlight check scenes/hal") == "scenes/hall.yaml\n");
  CHECK(complete_in_bash("patchlight render -o sce") == "scenes\n");
  CHECK(complete_in_bash("patchlight completion ''") == "bash zsh\n");
}

TEST_CASE("both scripts offer every verb and every flag that help lists") {
  const std::string bash = format_completion(Shell::kBash, list_words());
  const std::string zsh = format_completion(Shell::kZsh, list_words());
  CHECK(zsh.starts_with("#compdef patchlight\n"));
  for (const Verb& row : verbs()) {
    const std::string verb(row.name);
    CAPTURE(verb);
    CHECK(bash.find("    " + verb + ")\n") != std::string::npos);
    CHECK(zsh.find("    " + verb + ")\n") != std::string::npos);
    std::string help = parse_command_line({verb, "--help"}).text;
    help = help.substr(help.find("Options:"));
    size_t flags = 0;
    for (size_t at = 0; (at = help.find("\n  -", at)) != std::string::npos; ++flags) {
      at += 3;
      const std::string name = help.substr(at, help.find_first_of(" ,\n", at) - at);
      CAPTURE(name);
      CHECK(bash.find(name) != std::string::npos);
      CHECK(zsh.find("'*" + name + "[") != std::string::npos);
    }
    CHECK(flags > 0);
  }
}

TEST_CASE("text of the command line cannot break out of a script's quotes") {
  VerbWords verb{"v", "what's: that", {}};
  verb.usage.argument.name = "SCENE";
  verb.usage.flags.push_back({"--x", "A:B", "it's [odd]: \\"});
  const std::string zsh = format_completion(Shell::kZsh, std::vector{verb});
  CHECK(zsh.find("'*--x[it'\\''s \\[odd\\]\\: \\\\]:A\\:B:'") != std::string::npos);
  CHECK(zsh.find("'v:what'\\''s\\: that'") != std::string::npos);
}
