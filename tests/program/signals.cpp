// SIGINT and SIGTERM while a run goes: finished pictures stay, nothing else does.
#include "child.h"
#include "tools/base/json.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

// A run of 10,000 passes that would go on for long: pass 1 is pictured, and so would be the last.
void start_long_run(Child& child, const Folder& folder) {
  std::string scene = kBoxScene;
  scene += "solver: {until: 0, passes: 10000}\noutput: {snapshots: [1, 10000]}\n";
  write_bytes(folder / "box.yaml", scene);
  start_child(child, {"render", folder / "box.yaml", "-o", folder / "lit", "--size", "48x36", "--max-patches",
                      "50000", "--rays", "512", "--exposure", "0"});
}

// Waits until the path is there; false when the child ended before, or after a minute.
bool wait_for(const std::string& path, const Child& child) {
  for (int k = 0; k < 6000; ++k) {
    if (std::filesystem::exists(path)) return true;
    siginfo_t ended = {};
    waitid(P_PID, static_cast<id_t>(child.process), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (ended.si_pid != 0) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace

TEST_CASE("a signal in the middle of a pass keeps the finished pictures and writes the report") {
  for (const auto& [signal, name] : {std::pair<int, std::string>{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}}) {
    CAPTURE(name);
    const Folder folder;
    Child child;
    start_long_run(child, folder);
    CHECK(wait_for(folder / "lit/box-pass-01.png", child));
    kill(child.process, signal);
    const auto sent = std::chrono::steady_clock::now();
    const ChildResult result = finish_child(child);
    INFO(result.err);
    CHECK(result.exit_code == 128 + signal);
    CHECK(std::chrono::steady_clock::now() - sent < std::chrono::seconds(5));
    CHECK(list_names(folder / "lit") == "box-pass-01.png box-report.json");
    CHECK(is_whole_png(read_bytes(folder / "lit/box-pass-01.png")));
    CHECK(result.out == folder / "lit/box-report.json" + "\n" + (folder / "lit/box-pass-01.png") + "\n");
    CHECK(result.err.find("stopped by " + name) != std::string::npos);
    const Json json = Json::parse(read_bytes(folder / "lit/box-report.json"));
    CHECK(json["stopped"]["reason"] == "signal");
    CHECK(json["stopped"]["signal"] == name);
    CHECK(json["stopped"]["pass"].get<size_t>() >= 1);
    CHECK(json["passes"].size() == json["stopped"]["pass"].get<size_t>());
  }
}

TEST_CASE("a second signal ends the run at once and leaves no temporary files") {
  const Folder folder;
  Child child;
  start_long_run(child, folder);
  CHECK(wait_for(folder / "lit", child));
  for (int k = 0; k < 50 && kill(child.process, SIGINT) == 0; ++k) usleep(1000);
  const ChildResult result = finish_child(child);
  CHECK(result.exit_code == 130);
  if (std::filesystem::exists(folder / "lit"))
    CHECK(list_names(folder / "lit").find(".patchlight-") == std::string::npos);
}
