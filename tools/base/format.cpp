// Numbers as people read them.
#include "tools/base/format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace patchlight {

std::string format_count(uint64_t count) {
  const double value = static_cast<double>(count);
  if (count >= 1'000'000'000) return fmt::format("{:.3g} billion", value * 1e-9);
  if (count >= 1'000'000) return fmt::format("{:.3g} million", value * 1e-6);
  return fmt::format("{}", count);
}

std::string format_bytes(uint64_t bytes) {
  const double value = static_cast<double>(bytes);
  if (value >= 1e9) return fmt::format("{:.1f} GB", value * 1e-9);
  return fmt::format("{:.1f} MB", value * 1e-6);
}

std::string format_seconds(double seconds) {
  constexpr double kMinute = 60, kHour = 3600, kDay = 86'400;
  if (seconds >= 2 * kDay) return fmt::format("{:.3g} days", seconds / kDay);
  if (seconds >= 2 * kHour) return fmt::format("{:.3g} hours", seconds / kHour);
  if (seconds >= 2 * kMinute) return fmt::format("{:.3g} minutes", seconds / kMinute);
  return fmt::format("{:.2g} s", seconds);
}

std::string format_watts(double watts) {
  if (watts >= 1e6) return fmt::format("{:.3g} MW", watts * 1e-6);
  if (watts >= 1e3) return fmt::format("{:.3g} kW", watts * 1e-3);
  if (watts >= 1 || watts <= 0) return fmt::format("{:.3g} W", watts);
  return fmt::format("{:.3g} mW", watts * 1e3);
}

std::string name_steps(std::string_view step) {
  return fmt::format("{}{}", step, step == "pass" ? "es" : "s");
}

std::string name_solvers(bool Solver::*able) {
  std::vector<std::string_view> names;
  for (const Solver& solver : solvers())
    if (solver.*able) names.push_back(solver.name);
  return fmt::format("{}", fmt::join(names, " or "));
}

std::string quote_csv(const std::string& id) {
  return id.find(',') == std::string::npos ? id : '"' + id + '"';
}

}  // namespace patchlight
