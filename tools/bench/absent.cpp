// The sections of bench in a build without Google Benchmark: how to get one with it.
#include "dsl/report/diagnostics.h"
#include "tools/bench/sections.h"

namespace patchlight {

int run_sections(BenchOptions, Talk&) {
  throw UserError(
      "usage",
      "bench: this build leaves it out; with Google Benchmark installed (Debian: libbenchmark-dev), "
      "cmake -DPATCHLIGHT_BENCH=ON and building again put it in");
}

}  // namespace patchlight
