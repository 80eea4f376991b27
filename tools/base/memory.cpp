// Files of the kernel -> bytes. An allocation beyond the memory of a machine succeeds and the process is
// killed later, so a run is measured against this before it starts.
#include "tools/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

namespace patchlight {
namespace {

constexpr uint64_t kUnlimited = std::numeric_limits<uint64_t>::max();

// The number in a file that holds one; kUnlimited where there is none ("max").
uint64_t read_bytes(const std::string& path) {
  std::ifstream file(path);
  uint64_t bytes = 0;
  return file >> bytes ? bytes : kUnlimited;
}

uint64_t find_bytes_left(uint64_t limit, uint64_t used) {
  if (limit == kUnlimited || used == kUnlimited) return kUnlimited;
  return limit > used ? limit - used : 0;
}

uint64_t read_mem_available(const std::string& root) {
  std::ifstream file(root + "/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    uint64_t kibibytes = 0;
    if (words >> name >> kibibytes && name == "MemAvailable:") return kibibytes * 1024;
  }
  return kUnlimited;
}

// File pages in a group's cache can be dropped: they do not count as used.
uint64_t read_group_used(const std::string& folder, const char* usage_name) {
  const uint64_t used = read_bytes(folder + usage_name);
  if (used == kUnlimited) return kUnlimited;
  std::ifstream file(folder + "/memory.stat");
  std::string name;
  for (uint64_t bytes = 0; file >> name >> bytes;)
    if (name == "inactive_file" || name == "total_inactive_file") return used > bytes ? used - bytes : 0;
  return used;
}

// The least that any group from `path` up to the top leaves.
uint64_t find_group_left(const std::string& mount, std::string path, const char* limit_name,
                         const char* usage_name) {
  uint64_t left = kUnlimited;
  while (true) {
    const std::string folder = mount + path;
    const uint64_t limit = read_bytes(folder + limit_name);
    if (limit != kUnlimited)
      left = std::min(left, find_bytes_left(limit, read_group_used(folder, usage_name)));
    const size_t slash = path.rfind('/');
    if (path.empty() || slash == std::string::npos) return left;
    path.resize(slash);
  }
}

uint64_t find_groups_left(const std::string& root) {
  uint64_t left = kUnlimited;
  std::ifstream file(root + "/proc/self/cgroup");
  // Lines are "hierarchy:controllers:path"; version 2 has the hierarchy 0 and no controllers.
  for (std::string line; std::getline(file, line);) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    std::string path = line.substr(second + 1);
    if (path == "/") path.clear();
    if (controllers.empty())
      left = std::min(left, find_group_left(root + "/sys/fs/cgroup", path, "/memory.max", "/memory.current"));
    else if (("," + controllers + ",").find(",memory,") != std::string::npos)
      left = std::min(left, find_group_left(root + "/sys/fs/cgroup/memory", path, "/memory.limit_in_bytes",
                                            "/memory.usage_in_bytes"));
  }
  return left;
}

uint64_t find_address_space_left(const std::string& root) {
  rlimit limit = {};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const uint64_t pages = read_bytes(root + "/proc/self/statm");
  if (pages == kUnlimited) return limit.rlim_cur;
  return find_bytes_left(limit.rlim_cur, pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE)));
}

}  // namespace

uint64_t find_memory_available(const std::string& root) {
  return std::min({read_mem_available(root), find_groups_left(root), find_address_space_left(root)});
}

uint64_t find_memory_peak() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace patchlight
