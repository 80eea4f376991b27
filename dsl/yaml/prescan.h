// A light scan of YAML before the parser: it finds what the parser accepts though it should not (open quotes)
// or explains badly (open brackets, tabs), and says where the thing was opened.
#pragma once

#include "dsl/report/messages.h"

namespace patchlight {

// Scans messages.files[file].text. False after one error: yaml-unterminated-string at the quote,
// yaml-tab-indent, control-character, too-deep (brackets), yaml-syntax (brackets that do not match or stay
// open, text after a closing quote, ${name} inside brackets).
bool prescan(Messages& messages, uint32_t file);

}  // namespace patchlight
