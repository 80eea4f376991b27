// The program: sets up the process and hands over to run_program().
#include "tools/cli/program.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

namespace {

// A closed standard stream would give its number to the next file that is opened, and talk would end up in a
// picture. Opened the wrong way round it still fails as a closed one does.
void fill_closed_streams() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor)
    if (fcntl(descriptor, F_GETFD) < 0) {
      const int got = open("/dev/null", descriptor == 0 ? O_WRONLY : O_RDONLY);
      if (got != descriptor) _exit(4);
    }
}

}  // namespace

int main(int argument_count, char** arguments) {
  fill_closed_streams();
  // A reader that went away, or a file that grew too large, is an error of a write, not the end of the
  // process.
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  return patchlight::run_program(argument_count, arguments);
}
