#include "engine/base/parallel.h"

#include "engine/base/sampling.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>

using namespace patchlight;

TEST_CASE("for_rows: every row once, whatever the count, the grain and the threads") {
  for (const size_t threads : {1, 2, 5}) {
    const WorkersScope scope(std::make_shared<Workers>(threads));
    for (const size_t count : {0, 1, 7, 1000, 10007})
      for (const size_t grain : {0, 1, 64, 100000}) {
        std::vector<uint8_t> visits(count, 0);
        for_rows(count, grain, [&](size_t begin, size_t end) {
          for (size_t row = begin; row < end; ++row) ++visits[row];
        });
        CHECK(std::count(visits.begin(), visits.end(), 1) == static_cast<std::ptrdiff_t>(count));
      }
  }
}

TEST_CASE("for_rows: what a body throws comes out") {
  CHECK_THROWS_AS(for_rows(1000, 10,
                           [](size_t begin, size_t) {
                             if (begin >= 500) throw std::runtime_error("row");
                           }),
                  std::runtime_error);
}

TEST_CASE("for_rows: cancelled loops throw, before they begin and under way, and can be allowed again") {
  const auto workers = std::make_shared<Workers>(2);
  const WorkersScope scope(workers);
  workers->request_cancel();
  CHECK(cancel_requested());
  bool ran = false;
  CHECK_THROWS_AS(for_rows(10, 1, [&](size_t, size_t) { ran = true; }), Cancelled);
  CHECK_THROWS_AS(for_rows(0, 1, [&](size_t, size_t) { ran = true; }), Cancelled);
  CHECK(!ran);
  workers->clear_cancel();
  std::atomic<size_t> rows{0};
  CHECK_THROWS_AS(for_rows(100000, 1,
                           [&](size_t begin, size_t end) {
                             rows += end - begin;
                             workers->request_cancel();
                           }),
                  Cancelled);
  // Each thread ends the range that it has begun.
  CHECK(rows < 100000);
  workers->clear_cancel();
  CHECK_NOTHROW(for_rows(10, 1, [](size_t, size_t) {}));
}

TEST_CASE(
    "scopes: the innermost one counts, on its own thread and in its loops; outside of all, the process") {
  CHECK(current_workers() == default_workers());
  const auto outer = std::make_shared<Workers>(1), inner = std::make_shared<Workers>(2);
  const WorkersScope scope(outer);
  {
    const WorkersScope narrower(inner);
    CHECK(current_workers() == inner);
    std::atomic<size_t> others{0};
    for_rows(1000, 1, [&](size_t, size_t) { others += current_workers() != inner; });
    CHECK(others == 0);
    std::thread([&] { others += current_workers() != default_workers(); }).join();
    CHECK(others == 0);
  }
  CHECK(current_workers() == outer);
}

TEST_CASE("sort_keys: ascending, nothing lost") {
  std::vector<uint64_t> keys(50000);
  for (size_t k = 0; k < keys.size(); ++k) keys[k] = mix_bits(k) % 20000;
  std::vector<uint64_t> expected = keys;
  std::sort(expected.begin(), expected.end());
  sort_keys(keys);
  CHECK(keys == expected);
  std::vector<uint64_t> none;
  sort_keys(none);
  CHECK(none.empty());
}

TEST_CASE("thread counts: at least one, and as asked") {
  CHECK(thread_count_default() >= 1);
  CHECK(default_workers()->thread_count() >= 1);
  for (const size_t count : {1, 3}) CHECK(Workers(count).thread_count() == count);
  CHECK(Workers(0).thread_count() == 1);
}
