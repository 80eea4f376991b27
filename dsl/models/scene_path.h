// Files that a scene names: found only below the scene's own folder, and never on a network.
#pragma once

#include "dsl/report/messages.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace patchlight {

// A file that was looked for: `path` is canonical, or empty where there is none that may be read; then `slug`
// and `message` say why.
struct FoundFile {
  std::filesystem::path path;
  std::string_view slug;
  std::string message;
};

// Looks for a file that is named relative to `folder` (canonical). The slug is include-outside-root, or
// `missing_slug` where there is none. messages.files[0].folder is the scene's.
FoundFile locate_scene_file(const Messages& messages, const std::string& name,
                            const std::filesystem::path& folder, std::string_view missing_slug);

// The same, with the reason as an error at `place`: then the path is empty.
std::filesystem::path find_scene_file(Messages& messages, Place place, const std::string& name,
                                      const std::filesystem::path& folder, std::string_view missing_slug);

// The folder of the file at `place`, canonical: the scene's own for what the command line gives.
std::filesystem::path folder_of(const Messages& messages, Place place);

// Reads a file that find_scene_file found, its text unchecked, and adds it to messages.files. `limit` bounds
// the bytes of all files of its kind, `bytes_read` counts them. Returns the file's row, or kNone after an
// error at `place`: cannot-open, not-a-regular-file, file-too-large.
uint32_t add_scene_file(Messages& messages, Place place, const std::filesystem::path& path,
                        uint64_t Limits::*limit, uint64_t& bytes_read);

}  // namespace patchlight
