// Signals and a timer -> Workers::request_cancel().
#include "tools/base/stop.h"

#include "tools/base/files.h"

#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>

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

// The time is over: as the first signal, and nothing after one.
void on_alarm(int signal) {
  int none = 0;
  if (signal_seen.compare_exchange_strong(none, signal)) signal_workers.load()->request_cancel();
}

void set_timer(double seconds) {
  const double whole = std::floor(seconds);
  itimerval timer = {};
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - whole) * 1e6);
  setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace

StopSignals::StopSignals(Workers& stopped, double seconds_max) : workers(stopped) {
  signal_seen.store(0);
  signal_workers.store(&workers);
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // Writes in flight go on.
  sigaction(SIGINT, &action, &before_int);
  sigaction(SIGTERM, &action, &before_term);
  action.sa_handler = on_alarm;
  sigaction(SIGALRM, &action, &before_alarm);
  if (seconds_max > 0) set_timer(std::max(seconds_max, 1e-5));  // 0 would be no timer
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &before_int, nullptr);
  sigaction(SIGTERM, &before_term, nullptr);
  set_timer(0);
  sigaction(SIGALRM, &before_alarm, nullptr);
  workers.clear_cancel();
}

int stop_signal() noexcept { return signal_seen.load(); }

}  // namespace patchlight
