// The variables of a scene.
#include "variables.h"

#include "expression.h"
#include "values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace patchlight {

void read_let(const Context& context, uint32_t node, VariableTable& variables) {
  const Tree& tree = context.tree;
  for (uint32_t key = tree.nodes[node].first; key != kNone;) {
    const uint32_t value = tree.nodes[key].next;
    const std::string_view word = text_of(tree, key);
    if (!is_name(word) || word.find('-') != std::string_view::npos)
      add_error(
          context.messages, place_of(tree, key), "bad-name",
          fmt::format(
              "a variable's name begins with a letter or _ and goes on with letters, digits and _; got '{}'",
              escape_text(word)));
    std::string name = context.prefix + std::string(word);
    const auto [row, is_new] = variables.row_of.emplace(name, static_cast<uint32_t>(variables.size()));
    if (is_new) {
      variables.name.push_back(std::move(name));
      variables.prefix.push_back(context.prefix);
      variables.node.push_back(value);
      variables.value.push_back(0);
      variables.definition.emplace_back();
      variables.state.push_back(VariableTable::State::kWaiting);
    } else {
      add_error(context.messages, place_of(tree, key), "duplicate-id",
                fmt::format("the variable '{}' is taken: first defined at {}", escape_text(row->first),
                            place_text(context.messages, place_of(tree, variables.node[row->second]),
                                       place_of(tree, key))));
    }
    key = tree.nodes[value].next;
  }
}

namespace {

enum class Reading : uint8_t { kNumber, kNotFinite, kNoNumber };

// A number as the command line gives it: what a scene takes as one, or infinite and not-a-number by any name.
Reading read_definition(std::string_view text, double& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  const auto digit = [&](size_t k) { return k < digits.size() && digits[k] >= '0' && digits[k] <= '9'; };
  if (digits.starts_with('.') && !digit(1)) digits.remove_prefix(1);  // .inf, .nan
  if (digits.starts_with('0') && digit(1)) return Reading::kNoNumber;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (rest != digits.data() + digits.size() || error == std::errc::invalid_argument || digits.empty() ||
      digits.starts_with('-'))
    return Reading::kNoNumber;
  if (error == std::errc::result_out_of_range) {
    if (!is_tiny(digits)) return Reading::kNotFinite;
    value = 0;
  }
  if (text.starts_with('-')) value = -value;
  return std::isfinite(value) ? Reading::kNumber : Reading::kNotFinite;
}

}  // namespace

void define_variables(const Context& context, const std::vector<std::string>& definitions) {
  VariableTable& variables = *context.variables;
  for (const std::string& definition : definitions) {
    const size_t equals = std::min(definition.find('='), definition.size());
    const std::string name = definition.substr(0, equals);
    const std::string shown = escape_text(definition);
    const bool complete = equals > 0 && equals < definition.size();
    double value = 0;
    const Reading reading = complete ? read_definition(std::string_view(definition).substr(equals + 1), value)
                                     : Reading::kNoNumber;
    const auto row = variables.row_of.find(name);
    if (reading == Reading::kNoNumber) {
      add_command_line_error(context.messages, "usage", fmt::format("-D {}: expected NAME=NUMBER", shown));
    } else if (reading == Reading::kNotFinite) {
      add_command_line_error(context.messages, "non-finite",
                             fmt::format("-D {}: expected a finite number", shown));
    } else if (row == variables.row_of.end()) {
      const std::string near = did_you_mean(name, variables.name);
      add_command_line_error(
          context.messages, "undefined-variable",
          fmt::format("-D {}: the scene has no variable '{}'{}", shown, escape_text(name),
                      near.empty() ? "" : fmt::format("; did you mean '{}'?", escape_text(near))));
    } else {
      variables.value[row->second] = value;
      variables.definition[row->second] = "-D " + shown;
      variables.state[row->second] = VariableTable::State::kKnown;
    }
  }
}

namespace {

using State = VariableTable::State;

// A variable of a file whose names begin with `prefix`, else one of the scene; kNone where there is none.
uint32_t find_row(const VariableTable& variables, const std::string& prefix, std::string_view name) {
  auto row = variables.row_of.find(prefix + std::string(name));
  if (row == variables.row_of.end()) row = variables.row_of.find(std::string(name));
  return row == variables.row_of.end() ? kNone : row->second;
}

void report_cycle(const Context& context, uint32_t row) {
  VariableTable& variables = *context.variables;
  add_error(context.messages, place_of(context.tree, variables.node[row]), "variable-cycle",
            fmt::format("'{}' is defined by itself", escape_text(variables.name[row])));
  variables.state[row] = State::kFailed;
}

Lookup evaluate_row(const Context& context, uint32_t row, double& value) {
  VariableTable& variables = *context.variables;
  if (variables.state[row] == State::kBusy) report_cycle(context, row);
  if (variables.state[row] == State::kWaiting) {
    variables.state[row] = State::kBusy;
    Context own = context;
    own.prefix = variables.prefix[row];
    own.index.fill(std::nullopt);
    double number = 0;
    const bool good = read_number(own, variables.node[row], number) && variables.state[row] == State::kBusy;
    variables.value[row] = number;
    variables.state[row] = good ? State::kKnown : State::kFailed;
  }
  value = variables.value[row];
  return variables.state[row] == State::kKnown ? Lookup::kFound : Lookup::kFailed;
}

// Adds to `waiting` what a variable's text names and what is not known yet. What is open already would need
// itself.
void push_needed(const Context& context, uint32_t row, const std::vector<uint8_t>& open,
                 std::vector<uint32_t>& waiting) {
  const VariableTable& variables = *context.variables;
  const std::string_view text = text_of(context.tree, variables.node[row]);
  if (!is_expression(text)) return;
  for (size_t at = text.find('$'); at != std::string_view::npos; at = text.find('$', at + 1)) {
    const uint32_t needed = find_row(variables, variables.prefix[row], leading_name(text.substr(at + 1)));
    if (needed == kNone || variables.state[needed] != State::kWaiting) continue;
    if (open[needed])
      report_cycle(context, needed);
    else
      waiting.push_back(needed);
  }
}

}  // namespace

void check_variables(const Context& context) {
  // What a variable names comes before it, so that a chain of definitions, however long, is no deep
  // recursion.
  const VariableTable& variables = *context.variables;
  std::vector<uint8_t> open(variables.size(), 0);
  std::vector<uint32_t> waiting;
  double value = 0;
  for (uint32_t first = 0; first < variables.size(); ++first) {
    waiting.push_back(first);
    while (!waiting.empty()) {
      const uint32_t row = waiting.back();
      if (variables.state[row] == State::kWaiting && !open[row]) {
        open[row] = 1;
        push_needed(context, row, open, waiting);
        continue;
      }
      waiting.pop_back();
      evaluate_row(context, row, value);
    }
  }
}

Lookup find_variable(const Context& context, std::string_view name, double& value) {
  if (name.size() == 1 && name[0] >= 'i' && name[0] <= 'k') {
    if (const std::optional<double> index = context.index[static_cast<size_t>(name[0] - 'i')]) {
      value = *index;
      return Lookup::kFound;
    }
  }
  if (!context.variables) return Lookup::kUnknown;
  const uint32_t row = find_row(*context.variables, context.prefix, name);
  return row == kNone ? Lookup::kUnknown : evaluate_row(context, row, value);
}

std::string undefined_variable_text(const Context& context, std::string_view name) {
  std::string message =
      fmt::format("'{0}' is not defined; define it under 'let:' or with -D {0}=...", escape_text(name));
  if (!context.variables || !wants_errors(context.messages)) return message;
  if (const std::string near = did_you_mean(name, context.variables->name); !near.empty())
    message = fmt::format("'{}' is not defined; did you mean '{}'?", escape_text(name), escape_text(near));
  return message;
}

}  // namespace patchlight
