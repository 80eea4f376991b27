// Words of the command line -> exit code. All exceptions end here.
#include "tools/cli/program.h"

#include "tools/base/files.h"
#include "tools/base/json.h"
#include "tools/cli/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

namespace patchlight {
namespace {

constexpr int kExitOurMistake = 70;

Json make_messages(const std::vector<Diagnostic>& diagnostics) {
  Json messages = Json::array();
  for (const Diagnostic& diagnostic : diagnostics)
    messages.push_back({{"file", diagnostic.file},
                        {"line", diagnostic.line},
                        {"column", diagnostic.column},
                        {"severity", diagnostic.severity == Severity::kError ? "error" : "warning"},
                        {"slug", diagnostic.slug},
                        {"message", diagnostic.message}});
  return messages;
}

int report_user_error(const UserError& error, Talk& talk) {
  say_diagnostics(talk, error.diagnostics);
  if (error.more > 0 && !talk.json) say(talk, fmt::format("{} more errors", error.more));
  const auto first = std::find_if(error.diagnostics.begin(), error.diagnostics.end(),
                                  [](const Diagnostic& d) { return d.severity == Severity::kError; });
  return first == error.diagnostics.end() ? kExitOurMistake : exit_code(*first);
}

// Parses and runs; every failure becomes a message and a code.
int run_and_report(const std::vector<std::string>& words, Talk& talk) {
  try {
    const Command command = parse_command_line(words);
    talk = make_talk(command.options);
    if (command.verb != nullptr) return command.verb->run(command.options, talk);
    print_result(command.text);
    return 0;
  } catch (const UserError& error) {
    return report_user_error(error, talk);
  } catch (const std::bad_alloc&) {
    return report_user_error(
        UserError("out-of-memory", "the system gives no more memory; lower max_patches, rays or size"), talk);
  } catch (const std::exception& error) {
    talk.quiet = false;
    say(talk, fmt::format("patchlight: internal error: {}", error.what()));
    return kExitOurMistake;
  }
}

}  // namespace

int run_program(int argument_count, const char* const* arguments) {
  const std::vector<std::string> words(arguments + std::min(argument_count, 1), arguments + argument_count);
  Options before;  // How to speak while the command line is not understood yet.
  before.json = wants_json(words);
  Talk talk = make_talk(before);
  const int code = run_and_report(words, talk);
  if (!talk.json) return code;
  try {
    print_result(format_json(make_messages(talk.said)));
  } catch (const UserError& error) {
    talk.json = false;
    return std::max(code, report_user_error(error, talk));
  }
  return code;
}

}  // namespace patchlight
