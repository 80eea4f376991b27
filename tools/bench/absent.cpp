// The verb bench in a build without Google Benchmark: how to get one with it.
#include "dsl/diagnostics.h"
#include "tools/bench.h"

namespace patchlight {

int bench(const Options&, Talk&) {
  throw UserError(
      "usage",
      "bench: this build leaves it out; with Google Benchmark installed (Debian: libbenchmark-dev), "
      "cmake -DPATCHLIGHT_BENCH=ON and building again put it in");
}

}  // namespace patchlight
