#include "app/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <cstring>

#include "app/exit_status.hpp"

namespace grit {
namespace {

std::atomic<bool> was_interrupted{false};

// The second Ctrl-C ends the process.
extern "C" void on_interrupt(int signal) {
  was_interrupted.store(true);
  std::signal(signal, signal == SIGHUP ? SIG_IGN : SIG_DFL);
}

extern "C" void on_early_interrupt(int) {
  constexpr const char* text = "\ninterrupted before the run began; nothing was written\n";
  static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text)));
  ::_exit(static_cast<int>(ExitStatus::interrupted));
}

void handle(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto before = std::signal(signal, handler);
    if (signal == SIGHUP && before == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace

const std::atomic<bool>& end_on_interrupts() {
  handle(on_early_interrupt);
  return was_interrupted;
}

const std::atomic<bool>& catch_interrupts() {
  handle(on_interrupt);
  return was_interrupted;
}

}  // namespace grit
