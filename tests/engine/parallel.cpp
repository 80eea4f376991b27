#include "engine/parallel.h"

#include "engine/sampling.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <stdexcept>

using namespace patchlight;

TEST_CASE("for_rows: every row once, whatever the count, the grain and the threads") {
  for (const size_t threads : {1, 2, 5}) {
    set_thread_count(threads);
    for (const size_t count : {0, 1, 7, 1000, 10007})
      for (const size_t grain : {0, 1, 64, 100000}) {
        std::vector<uint8_t> visits(count, 0);
        for_rows(count, grain, [&](size_t begin, size_t end) {
          for (size_t row = begin; row < end; ++row) ++visits[row];
        });
        CHECK(std::count(visits.begin(), visits.end(), 1) == static_cast<std::ptrdiff_t>(count));
      }
  }
  set_thread_count(thread_count_default());
}

TEST_CASE("for_rows: what a body throws comes out") {
  CHECK_THROWS_AS(for_rows(1000, 10,
                           [](size_t begin, size_t) {
                             if (begin >= 500) throw std::runtime_error("row");
                           }),
                  std::runtime_error);
}

TEST_CASE("for_rows: cancelled loops throw, before they begin and under way, and can be allowed again") {
  request_cancel();
  CHECK(cancel_requested());
  bool ran = false;
  CHECK_THROWS_AS(for_rows(10, 1, [&](size_t, size_t) { ran = true; }), Cancelled);
  CHECK_THROWS_AS(for_rows(0, 1, [&](size_t, size_t) { ran = true; }), Cancelled);
  CHECK(!ran);
  clear_cancel();
  std::atomic<size_t> rows{0};
  CHECK_THROWS_AS(for_rows(100000, 1,
                           [&](size_t begin, size_t end) {
                             rows += end - begin;
                             request_cancel();
                           }),
                  Cancelled);
  // Each thread ends the range that it has begun.
  CHECK(rows < 100000);
  clear_cancel();
  CHECK_NOTHROW(for_rows(10, 1, [](size_t, size_t) {}));
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
  CHECK(set_thread_count(0) == 1);
  CHECK(set_thread_count(1) == 1);
  CHECK(set_thread_count(3) == 3);
  CHECK(thread_count() == 3);
  set_thread_count(thread_count_default());
}
