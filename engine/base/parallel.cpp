// Loops over rows on oneTBB.
#include "engine/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <latch>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace patchlight {

struct WorkersState {
  size_t count;
  std::atomic<bool> cancel{false};
  // oneTBB makes no more threads than there are cores, unless this is asked for.
  std::optional<tbb::global_control> more_than_cores;
  tbb::task_arena arena;

  explicit WorkersState(size_t threads) : count(threads), arena(static_cast<int>(threads)) {
    if (count > thread_count_default())
      more_than_cores.emplace(tbb::global_control::max_allowed_parallelism, count);
  }
};

namespace {

thread_local const std::shared_ptr<Workers>* scope_workers = nullptr;

// A scope without a share in the workers: somebody holds them while it lives.
struct BorrowedScope {
  const std::shared_ptr<Workers>* before;
  explicit BorrowedScope(const std::shared_ptr<Workers>& workers)
      : before(std::exchange(scope_workers, &workers)) {}
  BorrowedScope(const BorrowedScope&) = delete;
  BorrowedScope& operator=(const BorrowedScope&) = delete;
  ~BorrowedScope() { scope_workers = before; }
};

// Where the system refuses a thread, oneTBB would end the process: try first.
size_t find_granted(size_t count) {
  std::vector<std::thread> probes;
  std::latch all(1);
  try {
    while (probes.size() + 1 < count) probes.emplace_back([&] { all.wait(); });
  } catch (const std::system_error&) {
    count = probes.size() + 1;
  }
  all.count_down();
  for (std::thread& probe : probes) probe.join();
  return std::max<size_t>(count, 1);
}

const std::shared_ptr<Workers>& find_workers() { return scope_workers ? *scope_workers : default_workers(); }

}  // namespace

Workers::Workers(size_t count) : state_(std::make_unique<WorkersState>(find_granted(count))) {}
Workers::~Workers() = default;

size_t Workers::thread_count() const noexcept { return state_->count; }
void Workers::request_cancel() noexcept { state_->cancel.store(true, std::memory_order_relaxed); }
bool Workers::cancel_requested() const noexcept { return state_->cancel.load(std::memory_order_relaxed); }
void Workers::clear_cancel() noexcept { state_->cancel.store(false, std::memory_order_relaxed); }

size_t thread_count_default() { return static_cast<size_t>(std::max(tbb::info::default_concurrency(), 1)); }

const std::shared_ptr<Workers>& default_workers() {
  // Never destroyed: oneTBB may be gone before the last static object is.
  static const auto* const workers =
      new std::shared_ptr<Workers>(std::make_shared<Workers>(thread_count_default()));
  return *workers;
}

std::shared_ptr<Workers> current_workers() { return find_workers(); }

bool cancel_requested() noexcept { return find_workers()->cancel_requested(); }

WorkersScope::WorkersScope(std::shared_ptr<Workers> workers)
    : workers_(std::move(workers)), before_(scope_workers) {
  scope_workers = &workers_;
}
WorkersScope::~WorkersScope() { scope_workers = before_; }

void for_rows(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
  const std::shared_ptr<Workers> workers = current_workers();
  if (workers->cancel_requested()) throw Cancelled{};
  if (count == 0) return;
  workers->state().arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, std::max<size_t>(grain, 1)),
                      [&](const tbb::blocked_range<size_t>& range) {
                        if (workers->cancel_requested()) throw Cancelled{};
                        const BorrowedScope scope(workers);  // for loops inside of loops
                        body(range.begin(), range.end());
                      });
  });
}

void run_on_workers(const std::function<void()>& body) {
  find_workers()->state().arena.execute([&] { body(); });
}

void sort_keys(std::vector<uint64_t>& keys) {
  run_on_workers([&] { tbb::parallel_sort(keys.begin(), keys.end()); });
}

}  // namespace patchlight
