// Kernels to rates: the one door to Google Benchmark.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace patchlight {

enum class Clock { kProcessor, kWall };

struct Kernel {
  std::string name;
  std::string unit;  // of the rate
  size_t thread_count;
  Clock clock;                  // kProcessor: other programs disturb it less; for kernels of one thread
  std::function<double()> run;  // returns how much work it did
  std::function<void()> prepare = {};  // before each run, not timed
};

// Work a second of each kernel, `repetitions` times. Round robin: what disturbs the machine for a while then
// disturbs all alike, and figures of one round may be compared. A row a kernel, a column a round.
std::vector<std::vector<double>> measure_kernels(const std::vector<Kernel>& kernels, size_t repetitions,
                                                 double seconds_min);

}  // namespace patchlight
