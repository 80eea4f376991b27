// Limits to words.
#include "dsl/report/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace patchlight {

std::string limit_text(const Limits& limits, uint64_t Limits::*limit) {
  const auto row = std::find_if(std::begin(kLimitRows), std::end(kLimitRows),
                                [&](const LimitRow& r) { return r.limit == limit; });
  assert(row != std::end(kLimitRows));
  constexpr uint64_t kMebi = 1 << 20;
  const uint64_t number = limits.*limit;
  const std::string amount = row->unit == "bytes" && number % kMebi == 0
                                 ? fmt::format("{} MiB", number / kMebi)
                                 : fmt::format("{} {}", number, row->unit);
  return fmt::format("{} ({} raises it)", amount, row->flag);
}

std::string find_image_fault(const Limits& limits, uint64_t width, uint64_t height) {
  const auto text = [&](uint64_t Limits::*limit) {
    return fmt::format("a picture of {} x {} is above the limit of {}", width, height,
                       limit_text(limits, limit));
  };
  if (std::max(width, height) > limits.image_side) return text(&Limits::image_side);
  return width * height > limits.image_pixels ? text(&Limits::image_pixels) : std::string{};
}

}  // namespace patchlight
