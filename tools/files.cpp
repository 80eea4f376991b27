// Bytes -> whole files, by the system's own calls: the C++ streams do not say why a write failed.
#include "files.h"

#include "dsl/report/diagnostics.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace patchlight {
namespace {

constexpr size_t kJobsMax = 2;
constexpr int kSlots = 16;

// Names of unfinished files, in fixed memory so that a signal handler may read them.
enum SlotState : int { kFree, kClaimed, kNamed };
struct Slot {
  std::atomic<int> state{kFree};
  char name[PATH_MAX];
};
std::array<Slot, kSlots> slots;

int claim_slot(const std::string& name) {
  if (name.size() >= PATH_MAX) return -1;
  for (int k = 0; k < kSlots; ++k) {
    int expected = kFree;
    if (!slots[k].state.compare_exchange_strong(expected, kClaimed)) continue;
    std::memcpy(slots[k].name, name.c_str(), name.size() + 1);
    slots[k].state.store(kNamed);
    return k;
  }
  return -1;
}

[[noreturn]] void fail(std::string_view slug, const std::string& path, int error) {
  throw UserError(slug, std::strerror(error), path);
}

// A name in the directory of `path` that does not depend on the file's own: that one may be as long as names
// can be.
std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> count{0};
  const size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash + 1);
  return fmt::format("{}.patchlight-{}-{}.tmp", folder, getpid(), count.fetch_add(1));
}

// Removes what is left of a file that was not committed.
void discard_file(NewFile& file) noexcept {
  if (file.descriptor >= 0) close(file.descriptor);
  file.descriptor = -1;
  if (!file.temporary.empty()) unlink(file.temporary.c_str());
  file.temporary.clear();
  if (file.slot >= 0) slots[file.slot].state.store(kFree);
  file.slot = -1;
}

// Makes a temporary file and returns 0, or the error number.
int try_open(NewFile& file, const std::string& path) {
  file.path = path;
  do {
    file.temporary = temporary_name(path);
    file.slot = claim_slot(file.temporary);
    if (file.slot < 0) {
      file.temporary.clear();
      return ENAMETOOLONG;
    }
    file.descriptor = open(file.temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file.descriptor >= 0) return 0;
    const int error = errno;
    // The name is not ours: a process that had this number before may have left it.
    file.temporary.clear();
    discard_file(file);
    if (error != EEXIST) return error;
  } while (true);
}

// Writes all bytes and returns 0, or the error number.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes.remove_prefix(static_cast<size_t>(count));
  }
  return 0;
}

}  // namespace

NewFile::~NewFile() { discard_file(*this); }

void open_file(NewFile& file, const std::string& path) {
  if (const int error = try_open(file, path)) fail("write-failed", path, error);
}

void append_file(NewFile& file, std::string_view bytes) {
  if (const int error = write_all(file.descriptor, bytes)) fail("write-failed", file.path, error);
}

void commit_file(NewFile& file) {
  // Some systems report a full disk only now; EINVAL comes from files that cannot be synced.
  if (fsync(file.descriptor) != 0 && errno != EINVAL) fail("write-failed", file.path, errno);
  const int closed = close(file.descriptor);
  file.descriptor = -1;
  if (closed != 0) fail("write-failed", file.path, errno);
  if (rename(file.temporary.c_str(), file.path.c_str()) != 0) fail("write-failed", file.path, errno);
  file.temporary.clear();
  discard_file(file);
}

void write_file(const std::string& path, std::string_view bytes) {
  NewFile file;
  open_file(file, path);
  append_file(file, bytes);
  commit_file(file);
}

void remove_temporaries() noexcept {
  for (Slot& slot : slots)
    if (slot.state.load() == kNamed) unlink(slot.name);
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path(std::move(other.path)), descriptor(std::exchange(other.descriptor, -1)) {}

OutputFolder::~OutputFolder() {
  if (descriptor >= 0) close(descriptor);
}

OutputFolder open_output_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error && !std::filesystem::is_directory(path)) {
    const bool in_the_way = std::filesystem::exists(path) || error.value() == ENOTDIR;
    throw UserError("cannot-write", in_the_way ? "this is a file; expected a directory" : error.message(),
                    path);
  }
  OutputFolder folder;
  folder.path = path;
  folder.descriptor = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder.descriptor < 0) fail("cannot-write", path, errno);
  // The lock is on the directory itself and leaves no file; file systems without locks go without.
  if (flock(folder.descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw UserError("output-locked", "another run of patchlight writes into this directory", path);
  check_file_writable(path + "/x");
  return folder;
}

void check_file_writable(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw UserError("cannot-write", "this is a directory", path);
  NewFile probe;
  if (const int error = try_open(probe, path)) {
    const size_t slash = path.rfind('/');
    fail("cannot-write", slash == std::string::npos ? "." : path.substr(0, slash + 1), error);
  }
}

void push_job(JobQueue& queue, std::function<void()> job) {
  while (queue.pending.size() >= kJobsMax) {
    std::future<void> oldest = std::move(queue.pending.front());
    queue.pending.pop_front();
    oldest.get();
  }
  try {
    queue.pending.push_back(std::async(std::launch::async, job));
  } catch (const std::system_error&) {
    job();  // The system grants no further thread.
  }
}

void finish_jobs(JobQueue& queue) {
  while (!queue.pending.empty()) {
    std::future<void> oldest = std::move(queue.pending.front());
    queue.pending.pop_front();
    oldest.get();
  }
}

void print_result(std::string_view text) {
  const int error = write_all(STDOUT_FILENO, text);
  if (error != 0 && error != EPIPE) fail("write-failed", "standard output", error);
}

void check_standard_output() {
  const int flags = fcntl(STDOUT_FILENO, F_GETFL);
  if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
    throw UserError("write-failed", "it is closed", "standard output");
}

}  // namespace patchlight
