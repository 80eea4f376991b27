// fork, limits, streams, exec.
#include "child.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

namespace patchlight::testing {
namespace {

void open_as(int descriptor, const char* path, int flags) {
  const int opened = open(path, flags, 0666);
  if (opened < 0) _exit(126);
  dup2(opened, descriptor);
  close(opened);
}

}  // namespace

const char* const kBoxScene = R"(patchlight: 1
materials:
  white: {reflectance: [0.73, 0.73, 0.73]}
  lamp: {reflectance: 0.0, emission: [15, 15, 12]}
objects:
  - {id: floor, polygon: [[0,0,0],[0,0,1],[1,0,1],[1,0,0]], material: white, subdivide: 4}
  - {id: wall, polygon: [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], material: white}
  - {id: light, polygon: [[0.2,1,0.2],[0.8,1,0.2],[0.8,1,0.8],[0.2,1,0.8]], material: lamp}
)";

const std::vector<std::string> kShortRun = {"--size", "48x36", "--rays", "32", "--max-patches", "4000"};

std::vector<std::string> render_words(const std::string& scene, const std::string& out,
                                      const std::vector<std::string>& more) {
  std::vector<std::string> words = {"render", scene, "-o", out};
  words.insert(words.end(), kShortRun.begin(), kShortRun.end());
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void start_child(Child& child, const std::vector<std::string>& arguments, const ChildSettings& settings) {
  // Everything that allocates comes before fork: other threads may hold locks.
  const std::string in = child.folder / "in", err = child.folder / "err";
  const std::string out = settings.output.empty() ? child.folder / "out" : settings.output;
  write_bytes(in, settings.input);
  std::vector<std::string> words = {PATCHLIGHT_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> word_pointers;
  for (std::string& word : words) word_pointers.push_back(word.data());
  word_pointers.push_back(nullptr);
  std::vector<std::string> variables;
  for (const auto& [name, value] : settings.environment) variables.push_back(name + "=" + value);
  std::vector<char*> variable_pointers;
  for (std::string& variable : variables) variable_pointers.push_back(variable.data());
  for (char** own = environ; *own != nullptr; ++own) variable_pointers.push_back(*own);
  variable_pointers.push_back(nullptr);

  child.process = fork();
  REQUIRE(child.process >= 0);
  if (child.process > 0) return;
  open_as(STDIN_FILENO, in.c_str(), O_RDONLY);
  open_as(STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  if (settings.output_closed)
    close(STDOUT_FILENO);
  else
    open_as(STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT);
  if (settings.file_bytes_max) {
    const rlimit limit = {*settings.file_bytes_max, *settings.file_bytes_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (settings.address_bytes_max) {
    const rlimit limit = {*settings.address_bytes_max, *settings.address_bytes_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  execve(word_pointers[0], word_pointers.data(), variable_pointers.data());
  _exit(127);
}

ChildResult finish_child(Child& child) {
  int status = 0;
  while (waitpid(child.process, &status, 0) < 0) REQUIRE(errno == EINTR);
  child.process = -1;
  ChildResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (access((child.folder / "out").c_str(), R_OK) == 0) result.out = read_bytes(child.folder / "out");
  result.err = read_bytes(child.folder / "err");
  return result;
}

ChildResult run_child(const std::vector<std::string>& arguments, const ChildSettings& settings) {
  Child child;
  start_child(child, arguments, settings);
  return finish_child(child);
}

bool is_whole_png(const std::string& bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.size() > 8 + 12 &&
         bytes.substr(bytes.size() - 8, 4) == "IEND";
}

}  // namespace patchlight::testing
