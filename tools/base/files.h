// Files that are whole or absent: written beside their place under a temporary name, checked, synced,
// renamed.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <string>
#include <string_view>

namespace patchlight {

// A file on its way: it appears under `path` on commit_file(), and leaves nothing behind otherwise.
struct NewFile {
  std::string path;
  std::string temporary;
  int descriptor = -1;
  int slot = -1;  // its place in the list that remove_temporaries() clears
  NewFile() = default;
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();
};

// These three throw UserError (write-failed) with the system's words.
void open_file(NewFile& file, const std::string& path);
void append_file(NewFile& file, std::string_view bytes);
void commit_file(NewFile& file);

// The three in one.
void write_file(const std::string& path, std::string_view bytes);

// Unlinks the temporary files of all threads; for a signal handler that ends the process.
void remove_temporaries() noexcept;

// A directory that is there, can be written, and belongs to this run alone until it goes out of scope.
struct OutputFolder {
  std::string path;
  int descriptor = -1;
  OutputFolder() = default;
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();
};

// Makes the directory with its parents where they are missing, and proves that files can be made in it.
// Throws UserError: cannot-write; output-locked while another run writes there.
OutputFolder open_output_folder(const std::string& path);
// The same proof for the directory of one file, without making or locking anything.
void check_file_writable(const std::string& path);

// Jobs that run beside the solver, at most two at a time, so that encoding a picture holds up no pass. A
// job's exception comes out of the next call.
struct JobQueue {
  std::deque<std::future<void>> pending;
};
void push_job(JobQueue& queue, std::function<void()> job);
void finish_jobs(JobQueue& queue);

// Writes results to standard output. A reader that went away is no mistake; all else throws UserError
// (write-failed).
void print_result(std::string_view text);
// Throws UserError (write-failed) where standard output is closed: better before the work than after it.
void check_standard_output();

}  // namespace patchlight
