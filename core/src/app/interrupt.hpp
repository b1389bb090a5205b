// Ctrl-C and SIGTERM end a run in good order; a second signal ends the process at once.
#pragma once

#include <atomic>

namespace grit {

/// Installs the handlers; returns the flag that they set.
const std::atomic<bool>& catch_interrupts();

}  // namespace grit
