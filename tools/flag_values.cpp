// Values of flags, from words to numbers and choices.
#include "flag_values.h"

#include "dsl/report/diagnostics.h"
#include "dsl/report/limits.h"
#include "exporters.h"
#include "options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace patchlight {

void fail_usage(const std::string& message) { throw UserError("usage", message); }

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> parts;
  size_t begin = 0;
  while (true) {
    const size_t comma = text.find(',', begin);
    parts.emplace_back(text.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return parts;
    begin = comma + 1;
  }
}

std::string hint(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = did_you_mean(word, known);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
}

uint64_t parse_count(std::string_view flag, std::string_view text, uint64_t low, uint64_t high) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole =
      !text.empty() && end == text.data() + text.size() && error != std::errc::invalid_argument;
  const bool leading_zero = text.size() > 1 && text[0] == '0';
  if (!whole || leading_zero)
    fail_usage(fmt::format("{}: found '{}', expected a whole number", flag, escape_text(text)));
  if (error == std::errc::result_out_of_range || value < low || value > high)
    fail_usage(fmt::format("{}: {} is outside {} to {}", flag, escape_text(text), low, high));
  return value;
}

uint64_t parse_bytes(std::string_view flag, std::string_view text) {
  constexpr std::string_view kUnits = "kMGT";
  const size_t unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
  if (unit == std::string_view::npos) return parse_count(flag, text, 1, ~uint64_t{0});
  uint64_t scale = 1000;
  for (size_t k = 0; k < unit; ++k) scale *= 1000;
  return scale * parse_count(flag, text.substr(0, text.size() - 1), 1, ~uint64_t{0} / scale);
}

double parse_number(std::string_view flag, std::string_view text, double low, double high) {
  // from_chars would also take inf, nan and 010.
  std::string_view digits = text;
  if (!digits.empty() && digits[0] == '-') digits.remove_prefix(1);
  const bool starts_well = !digits.empty() && (digits[0] == '.' || (digits[0] >= '0' && digits[0] <= '9'));
  const bool leading_zero = digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!starts_well || leading_zero || end != text.data() + text.size() ||
      error == std::errc::invalid_argument)
    fail_usage(fmt::format("{}: found '{}', expected a number", flag, escape_text(text)));
  if (error != std::errc{} || !(value >= low && value <= high))
    fail_usage(fmt::format("{}: {} is outside {} to {}", flag, escape_text(text), low, high));
  return value;
}

std::vector<uint32_t> parse_steps(std::string_view flag, std::string_view text) {
  std::vector<uint32_t> steps;
  for (const std::string& part : split_list(text)) {
    const size_t dash = part.find('-', 1);
    const uint64_t first = parse_count(flag, part.substr(0, dash), 1, kPassesFlagMax);
    const uint64_t last =
        dash == std::string::npos ? first : parse_count(flag, part.substr(dash + 1), first, kPassesFlagMax);
    for (uint64_t step = first; step <= last; ++step) steps.push_back(static_cast<uint32_t>(step));
  }
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  return steps;
}

std::array<uint32_t, 2> parse_size(std::string_view text) {
  const size_t cross = text.find('x');
  if (cross == std::string_view::npos)
    fail_usage(fmt::format("--size: found '{}', expected WIDTHxHEIGHT, such as 960x720", escape_text(text)));
  const uint64_t width = parse_count("--size", text.substr(0, cross), 1, ~uint32_t{0});
  const uint64_t height = parse_count("--size", text.substr(cross + 1), 1, ~uint32_t{0});
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

std::vector<std::string> parse_formats(std::string_view text) {
  const std::vector<std::string> known = exporter_formats();
  std::vector<std::string> formats;
  for (const std::string& part : split_list(text)) {
    if (std::find(known.begin(), known.end(), part) == known.end())
      fail_usage(fmt::format("--format: '{}' is not a format{}; known: {}", escape_text(part),
                             hint(part, known), fmt::join(known, ", ")));
    if (std::find(formats.begin(), formats.end(), part) == formats.end()) formats.push_back(part);
  }
  return formats;
}

ViewOptions parse_place(const std::string& text, ViewOptions view) {
  const size_t at = text.rfind('@');
  const std::vector<std::string> uv =
      at == std::string::npos ? std::vector<std::string>{} : split_list(text.substr(at + 1));
  if (at == 0 || uv.size() != 2)
    fail_usage(
        fmt::format("--from: found '{}', expected a polygon's id and a point of it, such as "
                    "hall.floor@0.5,0.8",
                    escape_text(text)));
  view.polygon = text.substr(0, at);
  view.u = parse_number("--from", uv[0], 0, 1);
  view.v = parse_number("--from", uv[1], 0, 1);
  return view;
}

size_t parse_choice(std::string_view flag, const std::string& text, const std::vector<std::string>& choices) {
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end())
    fail_usage(fmt::format("{}: found '{}', expected one of {}{}", flag, escape_text(text),
                           fmt::join(choices, ", "), hint(text, choices)));
  return static_cast<size_t>(found - choices.begin());
}

}  // namespace patchlight
