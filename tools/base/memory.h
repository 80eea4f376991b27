// What the system would still give to this process.
#pragma once

#include <cstdint>
#include <string>

namespace patchlight {

// Bytes that may still be taken: the least of MemAvailable, the memory left in each control group (v2 or v1)
// that holds this process, and the address space that is left (ulimit -v). `root` stands before /proc and
// /sys: tests put files of their own there. The largest number where nothing is known.
uint64_t find_memory_available(const std::string& root = "");

// Bytes: the most memory that this process ever held.
uint64_t find_memory_peak();

}  // namespace patchlight
