// Ctrl-C and termination end what runs in good order; a second signal ends it at once.
#pragma once

#include <atomic>

namespace grit {

/// From now on these signals set what is returned.
const std::atomic<bool>& catch_interrupts();

}  // namespace grit
