// Kernels to rates, by Google Benchmark: it finds how often to call a kernel so that the clock can tell.
#include "tools/bench/measure.h"

#include "engine/base/parallel.h"

#include <benchmark/benchmark.h>

#include <stdexcept>

namespace patchlight {
namespace {

// Collects, prints nothing. Benchmarks run in the order in which they were registered.
struct Collector : benchmark::BenchmarkReporter {
  std::vector<Run> collected;
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration) collected.push_back(run);
  }
};

void run_kernel(const Kernel& kernel, benchmark::State& state) {
  const WorkersScope scope(std::make_shared<Workers>(kernel.thread_count));
  double work = 0;
  for (auto _ : state) {
    if (kernel.prepare) {
      state.PauseTiming();
      kernel.prepare();
      state.ResumeTiming();
    }
    work += kernel.run();
  }
  state.counters["work"] = work;
}

}  // namespace

std::vector<std::vector<double>> measure_kernels(const std::vector<Kernel>& kernels, size_t repetitions,
                                                 double seconds_min) {
  for (const Kernel& kernel : kernels) {
    auto* entry = benchmark::RegisterBenchmark(
        kernel.name.c_str(), [&kernel](benchmark::State& state) { run_kernel(kernel, state); });
    entry->MinTime(seconds_min);
    kernel.clock == Clock::kWall ? entry->UseRealTime() : entry->MeasureProcessCPUTime();
  }
  std::vector<std::vector<double>> rates(kernels.size());
  for (size_t round = 0; round < repetitions; ++round) {
    Collector collector;
    benchmark::RunSpecifiedBenchmarks(&collector);
    if (collector.collected.size() != kernels.size()) throw std::runtime_error("a kernel was not measured");
    for (size_t k = 0; k < kernels.size(); ++k) {
      const auto& run = collector.collected[k];
      const double seconds =
          kernels[k].clock == Clock::kWall ? run.real_accumulated_time : run.cpu_accumulated_time;
      rates[k].push_back(run.counters.at("work").value / seconds);
    }
  }
  benchmark::ClearRegisteredBenchmarks();
  return rates;
}

}  // namespace patchlight
