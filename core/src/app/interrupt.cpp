#include "app/interrupt.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "app/exit_status.hpp"

namespace grit {
namespace {

std::atomic<bool> was_interrupted{false};

// The second Ctrl-C ends the process. A terminal that closes may send several hangups, and the system repeats SIGXCPU
// each second.
extern "C" void on_interrupt(int signal) {
  was_interrupted.store(true);
  std::signal(signal, signal == SIGHUP || signal == SIGXCPU ? SIG_IGN : SIG_DFL);
}

extern "C" void on_early_interrupt(int) {
  constexpr const char* text = "\ninterrupted before the run began; nothing was written\n";
  static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text)));
  ::_exit(static_cast<int>(ExitStatus::interrupted));
}

void handle(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    const auto before = std::signal(signal, handler);
    if (signal == SIGHUP && before == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace

void prepare_outputs() {
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(standard, F_GETFD) < 0) ::open("/dev/null", O_RDWR);  // the lowest free number
  std::signal(SIGXFSZ, SIG_IGN);
}

void outlive_readers() { std::signal(SIGPIPE, SIG_IGN); }

bool has_no_reader(int file) {
  pollfd output{file, 0, 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

const std::atomic<bool>& end_on_interrupts() {
  handle(on_early_interrupt);
  return was_interrupted;
}

const std::atomic<bool>& catch_interrupts() {
  handle(on_interrupt);
  return was_interrupted;
}

}  // namespace grit
