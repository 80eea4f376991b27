// The one door to oneTBB: the only parallel loop, thread count, cancellation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <vector>

namespace patchlight {

// Thrown out of the engine after request_cancel(): tables being written are then unfinished.
struct Cancelled : std::exception {
  const char* what() const noexcept override { return "cancelled"; }
};

// Calls body(begin, end) over [0, count) in ranges of about `grain` rows, on all threads. Every row must be
// written by one range only and from inputs that no range writes: then the result does not depend on the
// threads. Throws what a body throws, and Cancelled.
void for_rows(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

// Ascending order. Equal keys are alike, so that the result does not depend on the threads.
void sort_keys(std::vector<uint64_t>& keys);

// Threads for all later loops, >= 1; returns what the system grants (a starved system may give fewer).
size_t set_thread_count(size_t count);
size_t thread_count();
// The cores that this process may use.
size_t thread_count_default();

// Makes running and later for_rows throw Cancelled. Safe to call from a signal handler.
void request_cancel() noexcept;
bool cancel_requested() noexcept;
// Makes for_rows run again after a cancellation (tests, or a program that goes on).
void clear_cancel() noexcept;

}  // namespace patchlight
