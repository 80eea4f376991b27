// Radiosity after a pass -> words of 32 bits.
#include "tools/export/pass_record.h"

#include "engine/base/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace patchlight {
namespace {

constexpr int kMantissaBits = 9, kExponentBias = 15;
constexpr uint32_t kMantissaMask = (1u << kMantissaBits) - 1;
constexpr float kLargest = 65408;  // 511 / 512 * 2^16
constexpr size_t kGrain = 4096;

std::vector<uint32_t> pack_values(std::span<const Rgb> values, float gain) {
  std::vector<uint32_t> words(values.size());
  for_rows(values.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) words[row] = pack_shared_exponent(gain * values[row]);
  });
  return words;
}

}  // namespace

uint32_t pack_shared_exponent(Rgb value) {
  // The comparison is false for what is no number.
  for (int k = 0; k < 3; ++k) value[k] = value[k] > 0 ? std::min(value[k], kLargest) : 0.0f;
  if (largest(value) == 0) return 0;
  int exponent = 0;
  std::frexp(largest(value), &exponent);  // the largest is below 2^exponent
  exponent = std::max(exponent, -kExponentBias);
  const auto count_steps = [&](float channel) {
    return static_cast<uint32_t>(std::lround(std::ldexp(channel, kMantissaBits - exponent)));
  };
  // Rounding may carry the largest over the top.
  if (count_steps(largest(value)) > kMantissaMask) ++exponent;
  return count_steps(value.r) | count_steps(value.g) << kMantissaBits |
         count_steps(value.b) << 2 * kMantissaBits |
         static_cast<uint32_t>(exponent + kExponentBias) << 3 * kMantissaBits;
}

Rgb unpack_shared_exponent(uint32_t word) {
  const int exponent = static_cast<int>(word >> 3 * kMantissaBits) - kExponentBias - kMantissaBits;
  const auto channel = [&](int place) {
    return std::ldexp(static_cast<float>(word >> place * kMantissaBits & kMantissaMask), exponent);
  };
  return {channel(0), channel(1), channel(2)};
}

void record_pass(PassRecord& record, const Solution& solution, Rgb ambient, double ev, bool last) {
  const auto pass = static_cast<uint32_t>(solution.log.passes.size());
  const bool due = record.solver->chooses_steps ? std::has_single_bit(pass) : pass <= kRecordedPassesMax;
  if (!due && !last) return;
  const auto gain = static_cast<float>(std::exp2(ev));
  record.pass.push_back(pass);
  record.vertex.push_back(pack_values(vertex_radiosity(solution, ambient), gain));
  record.element.push_back(pack_values(solution.mesh.elements.radiosity, gain));
}

}  // namespace patchlight
