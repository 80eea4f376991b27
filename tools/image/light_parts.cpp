// The light after each pass -> the parts of it that pictures show.
#include "tools/image/light_parts.h"

#include "engine/base/parallel.h"

#include <cassert>

namespace patchlight {

std::vector<Rgb> pick_light(const LightHistory& history, std::span<const Rgb> now, Light light) {
  std::vector<Rgb> values(now.begin(), now.end());
  const bool split = !history.first.empty();
  if (light == Light::kAll || (!split && light == Light::kDirect)) return values;
  assert(!split || history.first.size() == now.size());
  for_rows(values.size(), 16384, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      // The surface through the corners is limited to the range around, which can take back a hair of what it
      // showed at a border after pass 1.
      const Rgb direct = split ? min(history.first[k], now[k]) : now[k];
      values[k] = light == Light::kDirect ? direct : now[k] - direct;
    }
  });
  return values;
}

std::vector<Rgb> find_added(const LightHistory& history) {
  std::vector<Rgb> added = history.now;
  if (history.before.empty()) return added;
  assert(history.before.size() == added.size());
  for_rows(added.size(), 16384, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) added[k] = max(added[k] - history.before[k], Rgb(0));
  });
  return added;
}

}  // namespace patchlight
