// What a verb says of itself: its help, its argument and its flags, as tables. The command line reads words
// by them, help and completion list them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

// What a flag's value is called (FILE, DIR, a|b|c) is also what shells complete it with.
struct Flag {
  std::string name;   // -o, --passes
  std::string value;  // what its value is called: FILE, DIR, a|b|c, a|b|c,...; empty: it takes none
  std::string help;
  std::string group = {};  // its heading in help; empty: the usual one
  // One of these three: a switch; the values of a flag that may be given often; what reads the value of a
  // flag that may be given once, and throws UserError (usage) where it is wrong.
  bool* on = nullptr;
  std::vector<std::string>* list = nullptr;
  std::function<void(const std::string&)> read = {};
};

// The words that belong to no flag.
struct Argument {
  std::string name;        // SCENE, SHELL; empty: the verb takes none
  std::string value = {};  // as of a flag; empty: a file
  std::string help = {};
  // One of these two: exactly one word, or any number of them.
  std::string* word = nullptr;
  std::vector<std::string>* list = nullptr;
};

struct Usage {
  std::string help;  // what the verb does, examples first
  Argument argument;
  std::vector<Flag> flags;
  // What must hold of all flags together, in this order; they throw UserError (usage).
  std::vector<std::function<void()>> checks;
};

using ReadValue = std::function<void(const std::string&)>;

// A flag with one value that `read` understands.
void add_value(Usage& usage, std::string_view name, std::string_view value, std::string help, ReadValue read);
// A flag whose value is one of some words; `read` gets its index.
void add_choice(Usage& usage, std::string_view name, const std::vector<std::string>& choices,
                std::string help, std::function<void(size_t)> read);
// A flag without a value.
void add_switch(Usage& usage, std::string_view name, bool& on, std::string help);
// A flag that may be given often, with one value each time.
void add_list(Usage& usage, std::string_view name, std::string_view value, std::string help,
              std::vector<std::string>& list);

}  // namespace patchlight
