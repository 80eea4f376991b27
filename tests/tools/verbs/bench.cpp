// The parts of the benchmark that do not measure: its command line, its figures, its child processes.
#include "dsl/report/diagnostics.h"
#include "engine/solve/sizes.h"
#include "tests/scenes.h"
#include "tests/tools/mistakes.h"
#include "tools/bench/apart.h"
#include "tools/bench/figure.h"
#include "tools/bench/measure.h"
#include "tools/bench/sections.h"
#include "tools/bench/solve_case.h"
#include "tools/cli/command_line.h"

#include <doctest/doctest.h>

using namespace patchlight;
using namespace patchlight::testing;

TEST_CASE("bench with all of its flags, and without any") {
  const Options options = parse_options({"bench", "a.yaml", "b.yaml", "--only", "growth,threads", "--json",
                                         "b.json", "--repetitions", "3", "--seconds", "0.5", "--threads", "2",
                                         "--max-patches", "5000", "--max-memory", "1000000", "--quiet"});
  const BenchOptions& bench = get_own<BenchOptions>(options);
  CHECK(bench.scenes == std::vector<std::string>{"a.yaml", "b.yaml"});
  CHECK(bench.sections == std::vector<std::string>{"growth", "threads"});
  CHECK(bench.json == "b.json");
  CHECK(bench.repetitions == 3);
  CHECK(bench.seconds == 0.5);
  CHECK(bench.threads == 2);
  CHECK(bench.max_patches == 5000);
  CHECK(bench.max_memory == 1000000);
  CHECK(options.quiet);
  const Options plain = parse_options({"bench"});
  const BenchOptions& usual = get_own<BenchOptions>(plain);
  CHECK(usual.scenes.empty());
  CHECK(usual.sections == std::vector<std::string>{"kernels", "scenes"});
}

TEST_CASE("mistakes on bench's command line are usage errors") {
  struct Mistake {
    std::vector<std::string> words;
    const char* said;
  };
  for (const Mistake& mistake :
       {Mistake{{"bench", "--only", "kernel"}, "expected one of kernels, scenes, loading, growth, threads"},
        {{"bench", "--only", ""}, "expected one of"},
        {{"bench", "--repetitions", "0"}, "0 is outside 1 to 1000"},
        {{"bench", "--seconds", "0"}, "outside"},
        {{"bench", "--json"}, "--json: expected exactly one value"},
        {{"bench", "-"}, "expected the path of a scene file"},
        {{"bench", "--passes", "3"}, "bench has no flag '--passes'"},
        {{"bench", "--repetition", "3"}, "did you mean '--repetitions'?"}}) {
    const std::string said = find_mistake(mistake.words);
    CAPTURE(said);
    CHECK(said.starts_with("usage: "));
    CHECK_MESSAGE(said.find(mistake.said) != std::string::npos, mistake.said);
  }
}

TEST_CASE("a figure is the median of its runs with the extremes, and says when they are far apart") {
  const Json odd = make_figure({3e6, 1e6, 2e6}, "rays/s");
  CHECK(odd["median"] == 2e6);
  CHECK(odd["low"] == 1e6);
  CHECK(odd["high"] == 3e6);
  CHECK(odd["runs"] == 3);
  CHECK(format_figure(odd) == "2 Mrays/s (1 .. 3)");
  const Json even = make_figure({1.0, 1.02}, "s");
  CHECK(even["median"].get<double>() == doctest::Approx(1.01));
  CHECK(format_figure(make_figure({0.5}, "")) == "0.5 (1 run)");
  const Noise noise = find_noise({{"a", Json::array({odd, even})}, {"b", {{"c", even}}}, {"d", 1}});
  CHECK(noise.figure_count == 3);
  CHECK(noise.noisy_count == 1);
}

TEST_CASE("kernels are measured in rounds, each with its preparation") {
  int prepared = 0, run = 0;
  double sink = 0;
  const std::vector<Kernel> kernels = {{"sum", "terms/s", 1, Clock::kProcessor,
                                        [&] {
                                          ++run;
                                          for (int k = 1; k <= 1000; ++k) sink += 1.0 / k;
                                          return 1000.0;
                                        },
                                        [&] { ++prepared; }},
                                       {"none", "terms/s", 1, Clock::kWall, [] { return 1.0; }}};
  const auto rates = measure_kernels(kernels, 2, 0.001);
  REQUIRE(rates.size() == 2);
  for (const std::vector<double>& row : rates) {
    CHECK(row.size() == 2);
    for (const double rate : row) CHECK(rate > 0);
  }
  CHECK(run > 0);
  CHECK(run == prepared);
  CHECK(sink > 0);
}

TEST_CASE("a measurement apart gives its value, or its user's error") {
  CHECK(run_apart([] { return Json{{"a", 1.5}}; })["a"] == 1.5);
  CHECK_THROWS_AS(run_apart([]() -> Json { throw std::runtime_error("no"); }), std::runtime_error);
  try {
    run_apart([]() -> Json { throw UserError("too-many-patches", "found 3", "a.yaml"); });
    FAIL("no error came out");
  } catch (const UserError& error) {
    CHECK(error.diagnostics.front().slug == "too-many-patches");
    CHECK(error.diagnostics.front().message == "found 3");
    CHECK(error.diagnostics.front().file == "a.yaml");
  }
}

TEST_CASE("a mesh of a wanted size starts with half of it; none where the faces are too many") {
  FaceTable faces;
  add_quad(faces, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {});
  for (const uint64_t count : {100u, 10000u, 1000000u}) {
    const auto settings = settings_for_count(faces, {}, count);
    REQUIRE(settings);
    CHECK(settings->patch_count_max == count);
    CHECK(count_starting_patches(faces, *settings) <= count / 2);
    CHECK(4 * count_starting_patches(faces, *settings) > count / 2);
    CHECK(settings->patch_size_min == 0);
  }
  CHECK(!settings_for_count(faces, {}, 1));
}
