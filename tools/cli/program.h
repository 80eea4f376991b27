// The whole program as a function, so that tests can call it.
#pragma once

namespace patchlight {

// Runs the verb of the command line; says on standard error what went wrong. Returns the exit code: 0 done, 2
// usage, 3 the scene is wrong, 4 input/output, 5 a limit or memory, 70 a mistake of ours, 130 and 143 after a
// signal.
int run_program(int argument_count, const char* const* arguments);

}  // namespace patchlight
