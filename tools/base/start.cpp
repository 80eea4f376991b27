// What every verb that solves does first.
#include "tools/base/start.h"

#include <fmt/format.h>

namespace patchlight {

std::shared_ptr<Workers> start_workers(const Options& options, Talk& talk) {
  const size_t asked = options.threads ? *options.threads : thread_count_default();
  auto workers = std::make_shared<Workers>(asked);
  const size_t granted = workers->thread_count();
  if (granted < asked) say(talk, fmt::format("the system grants {} of {} threads", granted, asked));
  return workers;
}

}  // namespace patchlight
