// Files that a scene names: found only below the scene's own folder, and never on a network.
#pragma once

#include "messages.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace patchlight {

// The canonical path of a file that is named relative to `folder` (canonical) at `place`; empty after an
// error: include-outside-root, or `missing_slug` where there is none. messages.files[0].folder is the scene's.
std::filesystem::path find_scene_file(Messages& messages, Place place, const std::string& name,
                                      const std::filesystem::path& folder, std::string_view missing_slug);

// The folder of the file at `place`, canonical: the scene's own for what the command line gives.
std::filesystem::path folder_of(const Messages& messages, Place place);

// Reads a file that find_scene_file found, its text unchecked, and adds it to messages.files. Returns its row
// there, or kNone after an error at `place`: cannot-open, not-a-regular-file, file-too-large.
uint32_t add_scene_file(Messages& messages, Place place, const std::filesystem::path& path, size_t bytes_max);

}  // namespace patchlight
