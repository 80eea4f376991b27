// Signals -> Workers::request_cancel().
#include "tools/base/stop.h"

#include "tools/base/files.h"

#include <unistd.h>

#include <atomic>

namespace patchlight {
namespace {

std::atomic<int> signal_seen{0};
std::atomic<Workers*> signal_workers{nullptr};

void on_signal(int signal) {
  if (signal_seen.exchange(signal) != 0) {
    remove_temporaries();
    _exit(128 + signal);
  }
  signal_workers.load()->request_cancel();
}

}  // namespace

StopSignals::StopSignals(Workers& stopped) : workers(stopped) {
  signal_seen.store(0);
  signal_workers.store(&workers);
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // Writes in flight go on.
  sigaction(SIGINT, &action, &before_int);
  sigaction(SIGTERM, &action, &before_term);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &before_int, nullptr);
  sigaction(SIGTERM, &before_term, nullptr);
  workers.clear_cancel();
}

int stop_signal() noexcept { return signal_seen.load(); }

}  // namespace patchlight
