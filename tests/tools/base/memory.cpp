// How much memory there is, from files as the kernel shows them.
#include "tools/base/memory.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

void put(const Folder& folder, const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(folder / path).parent_path());
  write_bytes(folder / path, text);
}

}  // namespace

TEST_CASE("memory available is MemAvailable where no group limits it") {
  const Folder root;
  put(root, "proc/meminfo", "MemTotal:  9000 kB\nMemFree:  10 kB\nMemAvailable:  2000 kB\n");
  CHECK(find_memory_available(root.path) == 2000 * 1024);
}

TEST_CASE("the tightest group above the process counts, without the pages that can be dropped") {
  const Folder root;
  put(root, "proc/meminfo", "MemAvailable:  2000000 kB\n");
  put(root, "proc/self/cgroup", "0::/a/b\n");
  put(root, "sys/fs/cgroup/a/b/memory.max", "max\n");
  put(root, "sys/fs/cgroup/a/b/memory.current", "5\n");
  put(root, "sys/fs/cgroup/a/memory.max", "100000\n");
  put(root, "sys/fs/cgroup/a/memory.current", "60000\n");
  put(root, "sys/fs/cgroup/a/memory.stat", "anon 1\ninactive_file 20000\n");
  CHECK(find_memory_available(root.path) == 60000);
}

TEST_CASE("groups of version 1 count too, and a group that is over its limit leaves nothing") {
  const Folder root;
  put(root, "proc/meminfo", "MemAvailable:  2000000 kB\n");
  put(root, "proc/self/cgroup", "4:cpu:/x\n7:memory,hugetlb:/\n");
  put(root, "sys/fs/cgroup/memory/memory.limit_in_bytes", "1000\n");
  put(root, "sys/fs/cgroup/memory/memory.usage_in_bytes", "4000\n");
  CHECK(find_memory_available(root.path) == 0);
}

TEST_CASE("this system says how much memory there is") {
  CHECK(find_memory_available() > 0);
  CHECK(find_memory_peak() > 1000000);
}
