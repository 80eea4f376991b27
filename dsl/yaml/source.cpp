// Files and bytes to checked text.
#include "dsl/yaml/source.h"

#include "dsl/report/limits.h"
#include "dsl/yaml/prescan.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace patchlight {
namespace {

[[noreturn]] void throw_too_large(const std::string& name, std::string_view limit) {
  throw UserError("file-too-large", fmt::format("more than the limit of {}", limit), name);
}

Place place_of(const Messages& messages, uint32_t file, size_t offset) {
  const std::string& text = messages.files[file].text;
  Place place{file, 1, 1};
  size_t line_first = 0;
  for (size_t i = text.find('\n'); i < offset && i != std::string::npos; i = text.find('\n', i + 1)) {
    ++place.line;
    line_first = i + 1;
  }
  place.column = static_cast<uint32_t>(offset - line_first + 1);
  return place;
}

// Length of the UTF-8 character at text[i], 0 when it is none (RFC 3629: no overlong forms, no surrogates).
size_t utf8_length(std::string_view text, size_t i) {
  const auto byte = [&](size_t k) { return k < text.size() ? static_cast<uint8_t>(text[k]) : uint8_t{0}; };
  const uint8_t b0 = byte(i), b1 = byte(i + 1);
  const auto tail = [&](size_t k) { return (byte(k) & 0xc0) == 0x80; };
  if (b0 < 0x80) return 1;
  if (b0 < 0xc2) return 0;
  if (b0 < 0xe0) return tail(i + 1) ? 2 : 0;
  if (b0 < 0xf0) {
    if ((b0 == 0xe0 && b1 < 0xa0) || (b0 == 0xed && b1 > 0x9f)) return 0;
    return tail(i + 1) && tail(i + 2) ? 3 : 0;
  }
  if (b0 > 0xf4 || (b0 == 0xf0 && b1 < 0x90) || (b0 == 0xf4 && b1 > 0x8f)) return 0;
  return tail(i + 1) && tail(i + 2) && tail(i + 3) ? 4 : 0;
}

bool check_encoding(Messages& messages, uint32_t file) {
  const std::string& text = messages.files[file].text;
  size_t zeros = 0;
  const size_t head = std::min<size_t>(text.size(), 64);
  for (size_t i = 0; i < head; ++i) zeros += text[i] == 0;
  const bool utf16 =
      text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || (head > 3 && zeros * 3 > head);
  if (utf16) {
    add_error(messages, {file, 1, 1}, "not-utf8", "the file is UTF-16 or no text at all; save it as UTF-8");
    return false;
  }
  for (size_t i = 0; i < text.size();) {
    const size_t length = utf8_length(text, i);
    if (length == 0) {
      add_error(
          messages, place_of(messages, file, i), "not-utf8",
          fmt::format("byte {:#04x} is not UTF-8; save the file as UTF-8", static_cast<uint8_t>(text[i])));
      return false;
    }
    i += length;
  }
  return true;
}

}  // namespace

std::string read_bytes(const std::string& path, uint64_t bytes_max, std::string_view limit) {
  const bool from_input = path == "-";
  const std::string name = from_input ? "<stdin>" : path;
  // Non-blocking, so that a named pipe without a writer is refused instead of waited for.
  const int descriptor = from_input ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw UserError("cannot-open", std::strerror(errno), name);
  struct Closer {
    int descriptor;
    ~Closer() {
      if (descriptor != STDIN_FILENO) ::close(descriptor);
    }
  } closer{descriptor};
  if (!from_input) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) throw UserError("cannot-open", std::strerror(errno), name);
    if (S_ISCHR(status.st_mode)) throw_too_large(name, limit);  // a device has no end
    if (!S_ISREG(status.st_mode)) throw UserError("not-a-regular-file", "not a regular file", name);
    if (static_cast<uint64_t>(status.st_size) > bytes_max) throw_too_large(name, limit);
  }
  std::string bytes;
  for (;;) {
    const size_t filled = bytes.size();
    bytes.resize(filled + (size_t{1} << 18));
    const ssize_t count = ::read(descriptor, bytes.data() + filled, bytes.size() - filled);
    bytes.resize(filled + static_cast<size_t>(count > 0 ? count : 0));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw UserError("cannot-open", std::strerror(errno), name);
    if (count == 0) return bytes;
    if (bytes.size() > bytes_max) throw_too_large(name, limit);
  }
}

bool check_source(Messages& messages, uint32_t file) {
  std::string& text = messages.files[file].text;
  if (text.size() > messages.limits.scene_bytes) {
    add_error(messages, {file, 0, 0}, "file-too-large",
              fmt::format("more than the limit of {}", limit_text(messages.limits, &Limits::scene_bytes)));
    return false;
  }
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return check_encoding(messages, file) && prescan(messages, file);
}

}  // namespace patchlight
