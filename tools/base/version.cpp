// Build facts and processor -> text of --version. Versions of libraries come from CMake, so that no second
// file has to include them.
#include "tools/base/version.h"

#include "engine/base/parallel.h"
#include "engine/base/vector.h"
#include "engine/trace/tracer.h"

#include <fmt/format.h>

#include <fstream>

namespace patchlight {

const char* version_number() { return PATCHLIGHT_VERSION; }
const char* tbb_version() { return PATCHLIGHT_TBB_VERSION; }
const char* build_type() { return PATCHLIGHT_BUILD_TYPE; }
const char* compiler_version() { return "g++ " __VERSION__; }

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string version_text() {
  return fmt::format(
      "patchlight {}\n"
      "{}\n"
      "oneTBB {}, GLM {}.{}.{}, yaml-cpp {}, CLI11 {}, fmt {}, nlohmann-json {}, stb_image_write, tinyexr\n"
      "g++ {}\n"
      "{}, {} threads\n",
      PATCHLIGHT_VERSION, tracer_version(), PATCHLIGHT_TBB_VERSION, GLM_VERSION_MAJOR, GLM_VERSION_MINOR,
      GLM_VERSION_PATCH, PATCHLIGHT_YAML_CPP_VERSION, PATCHLIGHT_CLI11_VERSION, PATCHLIGHT_FMT_VERSION,
      PATCHLIGHT_JSON_VERSION, __VERSION__, processor_name(), thread_count_default());
}

}  // namespace patchlight
