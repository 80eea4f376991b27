// Files that a scene names: found only below the scene's own folder, and never on a network.
#include "dsl/models/scene_path.h"

#include "dsl/yaml/source.h"
#include "engine/base/vector.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

FoundFile locate_scene_file(const Messages& messages, const std::string& name, const fs::path& folder,
                            std::string_view missing_slug) {
  const std::string shown = escape_text(name);
  if (name.find("://") != std::string::npos)
    return {{}, missing_slug, fmt::format("'{}': only files are read, there is no network access", shown)};
  if (fs::path(name).is_absolute())
    return {{},
            "include-outside-root",
            fmt::format("'{}': paths are relative, inside the scene's folder", shown)};
  std::error_code error;
  const fs::path found = fs::weakly_canonical(folder / name, error);
  if (!error && !is_below(found, messages.files[0].folder))
    return {{}, "include-outside-root", fmt::format("'{}' lies outside of the scene's folder", shown)};
  if (error || !fs::exists(found, error))
    return {{},
            missing_slug,
            fmt::format("no file '{}'; looked in {}", shown, escape_text(folder.string(), 200))};
  return {found, {}, {}};
}

fs::path find_scene_file(Messages& messages, Place place, const std::string& name, const fs::path& folder,
                         std::string_view missing_slug) {
  FoundFile found = locate_scene_file(messages, name, folder, missing_slug);
  if (found.path.empty()) add_error(messages, place, found.slug, std::move(found.message));
  return found.path;
}

fs::path folder_of(const Messages& messages, Place place) {
  const std::string& folder = messages.files[place.file].folder;
  return folder.empty() ? messages.files[0].folder : folder;
}

uint32_t add_scene_file(Messages& messages, Place place, const fs::path& path, uint64_t Limits::*limit,
                        uint64_t& bytes_read) {
  const uint64_t bytes_max = messages.limits.*limit;
  try {
    SourceFile file;
    file.name = fs::relative(path, messages.files[0].folder).string();
    file.text = read_bytes(path.string(), bytes_max - std::min(bytes_read, bytes_max),
                           limit_text(messages.limits, limit));
    bytes_read += file.text.size();
    file.folder = path.parent_path().string();
    messages.files.push_back(std::move(file));
  } catch (const UserError& error) {
    add_error(messages, place, error.diagnostics[0].slug, error.diagnostics[0].message);
    return kNone;
  }
  return static_cast<uint32_t>(messages.files.size() - 1);
}

}  // namespace patchlight
