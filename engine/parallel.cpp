// Loops over rows on oneTBB.
#include "parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <latch>
#include <memory>
#include <system_error>
#include <thread>

namespace patchlight {
namespace {

std::atomic<bool> cancel_flag{false};
std::unique_ptr<tbb::global_control> thread_limit;

}  // namespace

void for_rows(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
  if (cancel_requested()) throw Cancelled{};
  if (count == 0) return;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, std::max<size_t>(grain, 1)),
                    [&](const tbb::blocked_range<size_t>& range) {
                      if (cancel_requested()) throw Cancelled{};
                      body(range.begin(), range.end());
                    });
}

void sort_keys(std::vector<uint64_t>& keys) { tbb::parallel_sort(keys.begin(), keys.end()); }

size_t set_thread_count(size_t count) {
  // Where the system refuses a thread, oneTBB would end the process: try first.
  std::vector<std::thread> probes;
  std::latch all(1);
  try {
    while (probes.size() + 1 < count) probes.emplace_back([&] { all.wait(); });
  } catch (const std::system_error&) {
    count = probes.size() + 1;
  }
  all.count_down();
  for (std::thread& probe : probes) probe.join();
  thread_limit.reset();
  thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                       std::max<size_t>(count, 1));
  return thread_count();
}

size_t thread_count() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

size_t thread_count_default() { return static_cast<size_t>(std::max(tbb::info::default_concurrency(), 1)); }

void request_cancel() noexcept { cancel_flag.store(true, std::memory_order_relaxed); }
bool cancel_requested() noexcept { return cancel_flag.load(std::memory_order_relaxed); }
void clear_cancel() noexcept { cancel_flag.store(false, std::memory_order_relaxed); }

}  // namespace patchlight
