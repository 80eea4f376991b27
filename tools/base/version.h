// What this program was built from and runs on.
#pragma once

#include <string>

namespace patchlight {

// The version of the program alone, such as 0.1.0.
const char* version_number();
// What a measurement depends on.
const char* tbb_version();
const char* build_type();
const char* compiler_version();
std::string processor_name();
// The program, its libraries, the compiler and the processor; several lines, newline at the end.
std::string version_text();

}  // namespace patchlight
