// The sections of the benchmark: each measures into JSON, and turns that JSON into lines to read.
#pragma once

#include "tools/base/json.h"
#include "tools/base/talk.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace patchlight {

struct BenchOptions {
  std::vector<std::string> scenes;  // paths; empty: those in scenes/
  std::vector<std::string> sections = {"kernels", "scenes"};
  std::string json;  // a file for the result; empty: none
  size_t repetitions = 5;
  double seconds = 0.2;                 // a repetition of a kernel takes at least so long
  size_t threads = 0;                   // 0: all cores
  uint64_t max_patches = ~uint64_t{0};  // no measured mesh has more
  uint64_t max_memory = ~uint64_t{0};   // bytes: growth stops before
};

// run_sections.cpp: measures, prints and writes the sections that were asked for; returns the exit code. In
// builds without the benchmark library it throws UserError (usage) that says how to get one with it.
int run_sections(BenchOptions asked, Talk& talk);

// kernels.cpp: rates of single kernels on the first scene, beside bare Embree and bare memory.
Json measure_kernels_section(const BenchOptions& options, Talk& talk);
std::string format_kernels(const Json& section);

// scenes.cpp: whole runs of the program, a scene a row.
Json measure_scenes(const BenchOptions& options, Talk& talk);
std::string format_scenes(const Json& section);

// loading.cpp: time and memory of loading large scenes beside the YAML parser alone.
Json measure_loading(const BenchOptions& options, Talk& talk);
std::string format_loading(const Json& section);

// growth.cpp: time and memory of the first scene's solve against the number of its patches.
Json measure_growth(const BenchOptions& options, Talk& talk);
std::string format_growth(const Json& section);

// threads.cpp: the first scene's solve on 1, 2, ... threads; "same" is false where the solutions differ.
Json measure_threads(const BenchOptions& options, Talk& talk);
std::string format_threads(const Json& section);

}  // namespace patchlight
