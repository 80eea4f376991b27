// Texts like =$w/2 to numbers, by recursive descent.
#include "dsl/language/expression.h"

#include "dsl/language/variables.h"
#include "dsl/report/limits.h"
#include "dsl/report/text.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

struct Failure {};  // reported already

struct Parser {
  const Context& context;
  uint32_t node;
  std::string_view text;
  size_t at = 0;
  uint64_t depth = 0;

  [[noreturn]] void fail(size_t offset, std::string_view slug, std::string message) const {
    Place place = place_of(context.tree, node);
    place.column += static_cast<uint32_t>(offset) + (context.tree.nodes[node].quoted ? 1 : 0);
    add_error(context.messages, place, slug, std::move(message));
    throw Failure{};
  }
  [[noreturn]] void fail_syntax(std::string_view expected) const {
    const std::string found =
        at < text.size() ? fmt::format("'{}'", escape_text(text.substr(at, 1))) : "the end";
    fail(at, "expression-syntax", fmt::format("expected {}, found {} in the expression", expected, found));
  }
  void skip_blanks() {
    while (at < text.size() && (text[at] == ' ' || text[at] == '\t' || text[at] == '\n')) ++at;
  }
  bool take(char c) {
    skip_blanks();
    if (at >= text.size() || text[at] != c) return false;
    ++at;
    return true;
  }
};

struct Function {
  std::string_view name;
  double (*apply)(double);
};
double sin_degrees(double x) { return std::fmod(x, 180) == 0 ? 0 : std::sin(x * std::numbers::pi / 180); }
double cos_degrees(double x) { return sin_degrees(x + 90); }
constexpr std::array kFunctions = {
    Function{"sin", sin_degrees},
    Function{"cos", cos_degrees},
    Function{"tan", [](double x) { return sin_degrees(x) / cos_degrees(x); }},
    Function{"sqrt", [](double x) { return std::sqrt(x); }},
    Function{"abs", [](double x) { return std::abs(x); }},
    Function{"floor", [](double x) { return std::floor(x); }},
};

double parse_sum(Parser& parser);

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view take_name(Parser& parser) {
  const std::string_view name = leading_name(parser.text.substr(parser.at));
  parser.at += name.size();
  return name;
}

double parse_variable(Parser& parser) {
  const size_t first = parser.at++;
  const std::string_view name = take_name(parser);
  if (name.empty()) parser.fail_syntax("a variable's name after '$'");
  double value = 0;
  const Lookup found = find_variable(parser.context, name, value);
  if (found == Lookup::kFound) return value;
  if (found == Lookup::kFailed) throw Failure{};
  parser.fail(first, "undefined-variable", undefined_variable_text(parser.context, name));
}

[[noreturn]] void fail_unknown_name(Parser& parser, size_t first, std::string_view name) {
  std::vector<std::string> known = {"pi", "min", "max"};
  for (const Function& row : kFunctions) known.emplace_back(row.name);
  const std::string near = did_you_mean(name, known);
  parser.fail(first, "expression-syntax",
              fmt::format("'{0}' is no function; {1}a variable is written ${0}", escape_text(name),
                          near.empty() ? "" : fmt::format("did you mean '{}'? ", near)));
}

double parse_call(Parser& parser) {
  const size_t first = parser.at;
  const std::string_view name = take_name(parser);
  if (name == "pi") return std::numbers::pi;
  const bool is_min = name == "min", is_max = name == "max";
  const Function* function = nullptr;
  for (const Function& row : kFunctions)
    if (row.name == name) function = &row;
  if (!function && !is_min && !is_max) fail_unknown_name(parser, first, name);
  if (!parser.take('(')) parser.fail_syntax(fmt::format("'(' after '{}'", name));
  double value = parse_sum(parser);
  while (!function && parser.take(',')) {
    const double other = parse_sum(parser);
    value = is_min ? std::min(value, other) : std::max(value, other);
  }
  if (!parser.take(')')) parser.fail_syntax(function ? "')'" : "',' or ')'");
  return function ? function->apply(value) : value;
}

double parse_primary(Parser& parser) {
  parser.skip_blanks();
  const char c = parser.at < parser.text.size() ? parser.text[parser.at] : '\0';
  if (c == '$') return parse_variable(parser);
  if (is_letter(c)) return parse_call(parser);
  if (parser.take('(')) {
    const double value = parse_sum(parser);
    if (!parser.take(')')) parser.fail_syntax("')'");
    return value;
  }
  if (!is_digit(c) && c != '.') parser.fail_syntax("a number, $name, a function or '('");
  double value = 0;
  const char* begin = parser.text.data() + parser.at;
  const auto [end, error] = std::from_chars(begin, parser.text.data() + parser.text.size(), value);
  if (error == std::errc::invalid_argument) parser.fail_syntax("a number");
  if (error == std::errc::result_out_of_range && !is_tiny(std::string_view(begin, end)))
    parser.fail(parser.at, "number-out-of-range", "this number is too large");
  parser.at += static_cast<size_t>(end - begin);
  return value;
}

double parse_unary(Parser& parser) {
  const Limits& limits = parser.context.messages.limits;
  if (++parser.depth > limits.expression_depth)
    parser.fail(
        parser.at, "expression-too-long",
        fmt::format("nested deeper than the limit of {}", limit_text(limits, &Limits::expression_depth)));
  double value = 0;
  if (parser.take('-')) {
    value = -parse_unary(parser);
  } else if (parser.take('+')) {
    value = parse_unary(parser);
  } else {
    value = parse_primary(parser);
    // Right to left, and before a minus in front: -2^2 is -4.
    if (parser.take('^')) value = std::pow(value, parse_unary(parser));
  }
  --parser.depth;
  return value;
}

double parse_product(Parser& parser) {
  double value = parse_unary(parser);
  for (;;) {
    if (parser.take('*'))
      value *= parse_unary(parser);
    else if (parser.take('/'))
      value /= parse_unary(parser);
    else
      return value;
  }
}

double parse_sum(Parser& parser) {
  double value = parse_product(parser);
  for (;;) {
    if (parser.take('+'))
      value += parse_product(parser);
    else if (parser.take('-'))
      value -= parse_product(parser);
    else
      return value;
  }
}

}  // namespace

std::string_view leading_name(std::string_view text) {
  size_t length = 0;
  const auto fits = [&](char c) { return is_letter(c) || (length > 0 && (is_digit(c) || c == '.')); };
  while (length < text.size() && fits(text[length])) ++length;
  return text.substr(0, length);
}

bool is_expression(std::string_view text) { return text.starts_with('=') || text.starts_with('$'); }

bool evaluate(const Context& context, uint32_t node, double& value) {
  Parser parser{context, node, text_of(context.tree, node)};
  try {
    const Limits& limits = context.messages.limits;
    if (parser.text.size() > limits.expression_characters)
      parser.fail(0, "expression-too-long",
                  fmt::format("{} characters, more than the limit of {}", parser.text.size(),
                              limit_text(limits, &Limits::expression_characters)));
    if (parser.text.starts_with('=')) {
      ++parser.at;
      value = parse_sum(parser);
    } else {
      value = parse_variable(parser);
    }
    parser.skip_blanks();
    if (parser.at < parser.text.size())
      parser.fail_syntax(parser.text.starts_with('=')
                             ? "an operator"
                             : "nothing more after the name; begin with '=' to compute");
    if (!std::isfinite(value)) {
      add_error(context.messages, place_of(context.tree, node), "non-finite",
                fmt::format("'{}' is not a finite number", escape_text(parser.text)));
      return false;
    }
  } catch (const Failure&) {
    return false;
  }
  return true;
}

}  // namespace patchlight
