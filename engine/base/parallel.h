// The one door to oneTBB: the only parallel loop, threads, cancellation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <vector>

namespace patchlight {

// Thrown out of the engine after request_cancel(): tables being written are then unfinished.
struct Cancelled : std::exception {
  const char* what() const noexcept override { return "cancelled"; }
};

// Threads, and a flag that stops what runs on them. Two solutions with workers of their own share nothing.
struct WorkersState;
class Workers {
 public:
  // As many threads as the system grants, `count` at most and at least one.
  explicit Workers(size_t count);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();

  size_t thread_count() const noexcept;
  // Makes running and later loops throw Cancelled. Safe to call from a signal handler.
  void request_cancel() noexcept;
  bool cancel_requested() const noexcept;
  // Makes loops run again after a cancellation.
  void clear_cancel() noexcept;

  WorkersState& state() const noexcept { return *state_; }

 private:
  std::unique_ptr<WorkersState> state_;
};

// The cores that this process may use.
size_t thread_count_default();
// Those of the process: as many as there are cores. They live until it ends.
const std::shared_ptr<Workers>& default_workers();
// Those of the innermost scope of this thread; outside of any, the process's.
std::shared_ptr<Workers> current_workers();
// Have they been asked to stop?
bool cancel_requested() noexcept;
// Throws Cancelled where they have: for long work between two rows.
inline void stop_if_cancelled() {
  if (cancel_requested()) throw Cancelled{};
}

// While it lives, loops of this thread run on these workers.
class WorkersScope {
 public:
  explicit WorkersScope(std::shared_ptr<Workers> workers);
  WorkersScope(const WorkersScope&) = delete;
  WorkersScope& operator=(const WorkersScope&) = delete;
  ~WorkersScope();

 private:
  std::shared_ptr<Workers> workers_;
  const std::shared_ptr<Workers>* before_;
};

// Calls body(begin, end) over [0, count) in ranges of about `grain` rows, on all workers. Every row must be
// written by one range only and from inputs that no range writes: then the result does not depend on the
// threads. Throws what a body throws, and Cancelled.
void for_rows(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

// Calls the body where other libraries find the same workers.
void run_on_workers(const std::function<void()>& body);

// Ascending order. Equal keys are alike, so that the result does not depend on the threads.
void sort_keys(std::vector<uint64_t>& keys);

}  // namespace patchlight
