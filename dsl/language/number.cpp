// Scalars to numbers by std::from_chars: no locale, no hexadecimal, no underscores, no quoted numbers.
#include "dsl/language/number.h"

#include "dsl/language/expression.h"
#include "dsl/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace patchlight {
namespace {

constexpr int64_t kIntegerMax = int64_t{1} << 62;

void report(const Context& context, uint32_t node, std::string_view slug, std::string message) {
  add_error(context.messages, place_of(context.tree, node), slug, std::move(message));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// YAML 1.1 reads 010 as eight, YAML 1.2 as ten.
bool is_ambiguous(std::string_view digits) {
  return digits.size() > 1 && digits[0] == '0' && is_digit(digits[1]);
}

bool is_infinite_or_nan(std::string_view digits) {
  for (const std::string_view word : {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN"})
    if (digits == word) return true;
  return false;
}

// The text of a plain scalar that may be a number, without its plus sign; reports everything else.
bool plain_text(const Context& context, uint32_t node, std::string_view slug, std::string_view what,
                std::string_view& text) {
  if (report_null(context, node, what)) return false;
  const Node& row = context.tree.nodes[node];
  if (row.kind != NodeKind::kScalar) {
    report(context, node, slug, fmt::format("expected {}, got {}", what, describe(context.tree, node)));
    return false;
  }
  text = text_of(context.tree, node);
  if (row.quoted) {
    report(context, node, slug,
           fmt::format("expected {}, got {}; take the quotes off", what, describe(context.tree, node)));
    return false;
  }
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  if (is_infinite_or_nan(digits)) {
    report(context, node, "non-finite", fmt::format("expected a finite number, got '{}'", escape_text(text)));
    return false;
  }
  return true;
}

// A whole number by an expression, up to rounding.
bool evaluate_integer(const Context& context, uint32_t node, int64_t& value) {
  double number = 0;
  if (!evaluate(context, node, number)) return false;
  const double whole = std::round(number);
  if (std::abs(number - whole) > 1e-9 * std::max(1.0, std::abs(whole))) {
    report(context, node, "expected-integer",
           fmt::format("expected a whole number, the expression gives {}", number_text(number)));
    return false;
  }
  if (std::abs(whole) > static_cast<double>(kIntegerMax)) {
    report(context, node, "number-out-of-range",
           fmt::format("{} is too large for a whole number", number_text(number)));
    return false;
  }
  value = static_cast<int64_t>(whole);
  return true;
}

bool report_ambiguous(const Context& context, uint32_t node, std::string_view text) {
  const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  if (!is_ambiguous(digits)) return false;
  report(context, node, "ambiguous-integer",
         fmt::format("'{}' is octal to some and decimal to others; take the leading zero off",
                     escape_text(text)));
  return true;
}

}  // namespace

bool report_null(const Context& context, uint32_t node, std::string_view expected) {
  if (context.tree.nodes[node].kind != NodeKind::kNull) return false;
  report(context, node, "null-value", fmt::format("nothing here; expected {}", expected));
  return true;
}

bool read_number(const Context& context, uint32_t node, double& value) {
  if (is_expression(text_of(context.tree, node))) return evaluate(context, node, value);
  std::string_view text;
  if (!plain_text(context, node, "expected-number", "a number", text)) return false;
  const bool numeric = !text.empty() && text.find_first_not_of("0123456789.+-eE") == std::string_view::npos;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!numeric || error == std::errc::invalid_argument || end != text.data() + text.size()) {
    report(context, node, "expected-number",
           fmt::format("expected a number like 2, -0.5 or 1e-3, got {}", describe(context.tree, node)));
    return false;
  }
  if (report_ambiguous(context, node, text)) return false;
  if (error == std::errc::result_out_of_range) {
    if (is_tiny(text)) {
      value = 0;
      return true;
    }
    report(context, node, "number-out-of-range",
           fmt::format("'{}' is too large for a number", escape_text(text)));
    return false;
  }
  return true;
}

bool read_integer(const Context& context, uint32_t node, int64_t& value) {
  if (is_expression(text_of(context.tree, node))) return evaluate_integer(context, node, value);
  std::string_view text;
  if (!plain_text(context, node, "expected-integer", "a whole number", text)) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::invalid_argument || end != text.data() + text.size()) {
    report(context, node, "expected-integer",
           fmt::format("expected a whole number, got {}", describe(context.tree, node)));
    return false;
  }
  if (report_ambiguous(context, node, text)) return false;
  if (error == std::errc::result_out_of_range || value > kIntegerMax || value < -kIntegerMax) {
    report(context, node, "number-out-of-range",
           fmt::format("'{}' is too large for a whole number", escape_text(text)));
    return false;
  }
  return true;
}

bool read_three(const Context& context, uint32_t node, std::string_view slug, double (&value)[3]) {
  const bool colour = slug == "expected-rgb";
  const std::string_view what = colour ? "a number or three numbers [r, g, b]" : "three numbers [x, y, z]";
  if (report_null(context, node, what)) return false;
  const Node& row = context.tree.nodes[node];
  if (row.kind != NodeKind::kList || row.count != 3) {
    std::string got = describe(context.tree, node);
    if (row.kind == NodeKind::kList) got = fmt::format("a list of {}", row.count);
    // [0 0 0] is a list of one text to YAML.
    const uint32_t word = row.kind == NodeKind::kList && row.count == 1 ? row.first : node;
    if (text_of(context.tree, word).find(' ') != std::string_view::npos)
      got = fmt::format("{}; separate the numbers with commas", describe(context.tree, word));
    report(context, node, slug, fmt::format("expected {}, got {}", what, got));
    return false;
  }
  bool good = true;
  uint32_t child = row.first;
  for (double& number : value) {
    good = read_number(context, child, number) && good;
    child = context.tree.nodes[child].next;
  }
  return good;
}

bool read_two(const Context& context, uint32_t node, double (&value)[3]) {
  if (report_null(context, node, "two numbers [a, b]")) return false;
  const Node& row = context.tree.nodes[node];
  if (row.kind != NodeKind::kList || row.count != 2) {
    report(context, node, "expected-list",
           fmt::format("expected two numbers [a, b], got {}", row.kind == NodeKind::kList
                                                                  ? fmt::format("a list of {}", row.count)
                                                                  : describe(context.tree, node)));
    return false;
  }
  const bool first = read_number(context, row.first, value[0]);
  const bool second = read_number(context, context.tree.nodes[row.first].next, value[1]);
  value[2] = 0;
  return first && second;
}

}  // namespace patchlight
