// The sections of the benchmark: each measures into JSON, and turns that JSON into lines to read.
#pragma once

#include "tools/json.h"
#include "tools/options.h"
#include "tools/talk.h"

#include <string>

namespace patchlight {

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
