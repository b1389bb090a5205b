#include "app/interrupt.hpp"

#include <csignal>

namespace grit {
namespace {

std::atomic<bool> interrupted{false};

// The second Ctrl-C ends the process.
extern "C" void on_interrupt(int signal) {
  interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, on_interrupt);
  return interrupted;
}

}  // namespace grit
