// What every verb that solves does first.
#include "tools/base/start.h"

#include "engine/parallel.h"

#include <fmt/format.h>

namespace patchlight {

size_t start_threads(const Options& options, Talk& talk) {
  const size_t asked = options.threads ? *options.threads : thread_count_default();
  const size_t granted = set_thread_count(asked);
  if (granted < asked) say(talk, fmt::format("the system grants {} of {} threads", granted, asked));
  return granted;
}

}  // namespace patchlight
