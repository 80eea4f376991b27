// The parser's own complaints to located messages that say what to write instead.
#pragma once

#include "dsl/report/messages.h"

namespace YAML {
class Exception;
}

namespace patchlight {

// Adds an error for what the parser threw while it read messages.files[file]: yaml-syntax,
// yaml-tab-indent, yaml-undefined-alias or too-deep.
void report_yaml_error(Messages& messages, uint32_t file, const YAML::Exception& error);

}  // namespace patchlight
