// A measurement in a process of its own: its peak of memory is its own, and nothing that ran before has
// warmed anything up.
#pragma once

#include "tools/base/json.h"

#include <functional>

namespace patchlight {

// Runs `body` in a child process and returns its JSON; a UserError of the child comes out here. The caller
// must not have started threads: they would be missing in the child.
Json run_apart(const std::function<Json()>& body);

}  // namespace patchlight
