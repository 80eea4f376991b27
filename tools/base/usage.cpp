// Rows of a verb's flags.
#include "tools/base/usage.h"

#include "tools/base/flag_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace patchlight {

void add_value(Usage& usage, std::string_view name, std::string_view value, std::string help,
               ReadValue read) {
  Flag& flag = usage.flags.emplace_back(Flag{std::string(name), std::string(value), std::move(help)});
  flag.read = std::move(read);
}

void add_choice(Usage& usage, std::string_view name, const std::vector<std::string>& choices,
                std::string help, std::function<void(size_t)> read) {
  add_value(
      usage, name, fmt::format("{}", fmt::join(choices, "|")), std::move(help),
      [=, flag = std::string(name)](const std::string& text) { read(parse_choice(flag, text, choices)); });
}

void add_switch(Usage& usage, std::string_view name, bool& on, std::string help) {
  usage.flags.emplace_back(Flag{std::string(name), "", std::move(help)}).on = &on;
}

void add_list(Usage& usage, std::string_view name, std::string_view value, std::string help,
              std::vector<std::string>& list) {
  usage.flags.emplace_back(Flag{std::string(name), std::string(value), std::move(help)}).list = &list;
}

}  // namespace patchlight
