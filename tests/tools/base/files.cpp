// Files that are whole or absent.
#include "tools/base/files.h"

#include "dsl/report/diagnostics.h"
#include "tests/folder.h"
#include "tests/tools/mistakes.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <atomic>
#include <stdexcept>

using namespace patchlight;
using namespace patchlight::testing;

TEST_CASE("a file appears whole, once it is committed") {
  const Folder folder;
  NewFile file;
  open_file(file, folder / "a.txt");
  append_file(file, "one, ");
  append_file(file, "two");
  CHECK(list_names(folder.path).starts_with(".patchlight-"));
  commit_file(file);
  CHECK(list_names(folder.path) == "a.txt");
  CHECK(read_bytes(folder / "a.txt") == "one, two");
}

TEST_CASE("a file that is not committed leaves nothing, and the old one as it was") {
  const Folder folder;
  write_bytes(folder / "a.txt", "old");
  {
    NewFile file;
    open_file(file, folder / "a.txt");
    append_file(file, "new");
  }
  CHECK(list_names(folder.path) == "a.txt");
  CHECK(read_bytes(folder / "a.txt") == "old");
}

TEST_CASE("temporary files can be removed from outside") {
  const Folder folder;
  NewFile file;
  open_file(file, folder / "a.txt");
  remove_temporaries();
  CHECK(list_names(folder.path).empty());
}

TEST_CASE("a file cannot be written over a directory or into nothing") {
  const Folder folder;
  CHECK(find_slug([&] { write_file(folder.path + "/no/a.txt", "x"); }) == "write-failed");
  mkdir((folder / "d").c_str(), 0777);
  CHECK(find_slug([&] { write_file(folder / "d", "x"); }) == "write-failed");
  CHECK(list_names(folder.path) == "d");
  CHECK(find_slug([&] { check_file_writable(folder / "d"); }) == "cannot-write");
  CHECK(find_slug([&] { check_file_writable(folder / "no/a.txt"); }) == "cannot-write");
}

TEST_CASE("an output folder is made with its parents and left empty") {
  const Folder folder;
  const OutputFolder out = open_output_folder(folder / "a/b");
  CHECK(out.path == folder / "a/b");
  CHECK(list_names(folder / "a/b").empty());
}

TEST_CASE("an output folder belongs to one run at a time") {
  const Folder folder;
  {
    const OutputFolder out = open_output_folder(folder.path);
    CHECK(find_slug([&] { open_output_folder(folder.path); }) == "output-locked");
  }
  CHECK(find_slug([&] { open_output_folder(folder.path); }).empty());
}

TEST_CASE("a file where the output folder should be is an error") {
  const Folder folder;
  write_bytes(folder / "out", "");
  CHECK(find_slug([&] { open_output_folder(folder / "out"); }) == "cannot-write");
  CHECK(find_slug([&] { open_output_folder(folder / "out/deeper"); }) == "cannot-write");
}

TEST_CASE("all jobs are done after finish_jobs, and a job's failure comes out") {
  JobQueue queue;
  std::atomic<int> done{0};
  for (int k = 0; k < 10; ++k) push_job(queue, [&] { ++done; });
  finish_jobs(queue);
  CHECK(done == 10);
  push_job(queue, [] { throw std::runtime_error("no"); });
  CHECK_THROWS_AS(finish_jobs(queue), std::runtime_error);
}
