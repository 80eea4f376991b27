// The maps `let` and the command line's definitions to the values of variables.
#include "dsl/language/let.h"

#include "dsl/language/expression.h"
#include "dsl/language/number.h"
#include "dsl/report/text.h"
#include "engine/base/vector.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace patchlight {
namespace {

using State = VariableTable::State;

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

void report_cycle(const Context& context, uint32_t row, VariableTable& variables) {
  add_error(context.messages, place_of(context.tree, variables.node[row]), "variable-cycle",
            fmt::format("'{}' is defined by itself", escape_text(variables.name[row])));
  variables.state[row] = State::kFailed;
}

// Reads the value of a variable; all that it names is known or failed.
void work_out(const Context& context, uint32_t row, VariableTable& variables) {
  Context own = context;
  own.prefix = variables.prefix[row];
  own.index.fill(std::nullopt);
  const bool good = read_number(own, variables.node[row], variables.value[row]);
  variables.state[row] = good ? State::kKnown : State::kFailed;
}

// Adds to `waiting` what a variable's text names and what is not known yet. What is open already would need
// itself.
void push_needed(const Context& context, uint32_t row, const std::vector<uint8_t>& open,
                 VariableTable& variables, std::vector<uint32_t>& waiting) {
  const std::string_view text = text_of(context.tree, variables.node[row]);
  if (!is_expression(text)) return;
  for (size_t at = text.find('$'); at != std::string_view::npos; at = text.find('$', at + 1)) {
    const uint32_t needed = find_row(variables, variables.prefix[row], leading_name(text.substr(at + 1)));
    if (needed == kNone || variables.state[needed] != State::kWaiting) continue;
    if (open[needed])
      report_cycle(context, needed, variables);
    else
      waiting.push_back(needed);
  }
}

}  // namespace

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
      variables.state.push_back(State::kWaiting);
    } else {
      add_error(context.messages, place_of(tree, key), "duplicate-id",
                fmt::format("the variable '{}' is taken: first defined at {}", escape_text(row->first),
                            place_text(context.messages, place_of(tree, variables.node[row->second]),
                                       place_of(tree, key))));
    }
    key = tree.nodes[value].next;
  }
}

void define_variables(Messages& messages, const std::vector<std::string>& definitions,
                      VariableTable& variables) {
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
      add_command_line_error(messages, "usage", fmt::format("-D {}: expected NAME=NUMBER", shown));
    } else if (reading == Reading::kNotFinite) {
      add_command_line_error(messages, "non-finite", fmt::format("-D {}: expected a finite number", shown));
    } else if (row == variables.row_of.end()) {
      const std::string near = did_you_mean(name, variables.name);
      add_command_line_error(
          messages, "undefined-variable",
          fmt::format("-D {}: the scene has no variable '{}'{}", shown, escape_text(name),
                      near.empty() ? "" : fmt::format("; did you mean '{}'?", escape_text(near))));
    } else {
      variables.value[row->second] = value;
      variables.definition[row->second] = "-D " + shown;
      variables.state[row->second] = State::kKnown;
    }
  }
}

void work_out_variables(const Context& context, VariableTable& variables) {
  // What a variable names comes before it, so that a chain of definitions, however long, is no deep
  // recursion.
  std::vector<uint8_t> open(variables.size(), 0);
  std::vector<uint32_t> waiting;
  for (uint32_t first = 0; first < variables.size(); ++first) {
    waiting.push_back(first);
    while (!waiting.empty()) {
      const uint32_t row = waiting.back();
      if (variables.state[row] == State::kWaiting && !open[row]) {
        open[row] = 1;
        push_needed(context, row, open, variables, waiting);
        continue;
      }
      waiting.pop_back();
      if (variables.state[row] == State::kWaiting) work_out(context, row, variables);
    }
  }
}

}  // namespace patchlight
