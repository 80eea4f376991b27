// Files and bytes to checked text: what reaches the YAML parser is UTF-8 without surprises.
#pragma once

#include "dsl/report/limits.h"
#include "dsl/report/messages.h"

#include <string>

namespace patchlight {

// The bytes of a file, at most bytes_max; `-` is standard input. Throws UserError: cannot-open,
// not-a-regular-file, file-too-large (the limit in words is `limit`).
std::string read_bytes(const std::string& path, uint64_t bytes_max, std::string_view limit);

// Checks messages.files[file].text in place: size, UTF-8 (a byte order mark is cut off), control characters,
// then quotes, brackets and tabs by a light scan of YAML (see prescan.h). False and one error or more when
// the text is not fit to be parsed: file-too-large, not-utf8, control-character, yaml-unterminated-string,
// yaml-tab-indent, yaml-syntax, too-deep.
bool check_source(Messages& messages, uint32_t file);

}  // namespace patchlight
