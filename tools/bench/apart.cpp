// A function to a child process, its JSON back through a pipe.
#include "tools/bench/apart.h"

#include "dsl/report/diagnostics.h"
#include "engine/base/parallel.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <stdexcept>

namespace patchlight {
namespace {

[[noreturn]] void run_child(const std::function<Json()>& body, int out) {
  // Whoever stops the benchmark stops what it measures; nothing here needs to be tidied up.
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Json answer;
  try {
    answer["value"] = body();
  } catch (const UserError& error) {
    const Diagnostic& first = error.diagnostics.front();
    answer["slug"] = first.slug, answer["message"] = first.message, answer["file"] = first.file;
  } catch (const std::bad_alloc&) {
    answer["slug"] = "out-of-memory", answer["message"] = "the system gives no more memory",
    answer["file"] = "";
  } catch (const std::exception& error) {
    answer["failed"] = error.what();
  }
  const std::string text = format_json(answer);
  for (size_t done = 0; done < text.size();) {
    const ssize_t count = write(out, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<size_t>(count);
  }
  // Not exit(): what the parent has buffered and registered is the parent's.
  _exit(0);
}

// All that the child writes until it ends; after a signal it ends now.
std::string read_answer(int in, pid_t child) {
  constexpr int kLookEvery = 200;  // milliseconds: a signal may come between looking and waiting
  std::string text;
  char buffer[4096];
  while (true) {
    if (cancel_requested()) {
      kill(child, SIGKILL);
      return text;
    }
    pollfd ready = {in, POLLIN, 0};
    if (poll(&ready, 1, kLookEvery) <= 0) continue;
    const ssize_t count = read(in, buffer, sizeof buffer);
    if (count > 0) text.append(buffer, static_cast<size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
  }
}

}  // namespace

Json run_apart(const std::function<Json()>& body) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::strerror(errno));
  if (child == 0) {
    close(ends[0]);
    run_child(body, ends[1]);
  }
  close(ends[1]);
  const std::string text = read_answer(ends[0], child);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (cancel_requested()) throw Cancelled{};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
    throw UserError("out-of-memory", "the system ended a measurement; lower --max-patches or --max-memory");
  const Json answer = Json::parse(text, nullptr, false);
  if (answer.is_discarded()) throw std::runtime_error("a measurement ended without a result");
  if (answer.contains("slug"))
    throw UserError(answer["slug"].get<std::string>(), answer["message"].get<std::string>(),
                    answer["file"].get<std::string>());
  if (answer.contains("failed")) throw std::runtime_error(answer["failed"].get<std::string>());
  return answer["value"];
}

}  // namespace patchlight
