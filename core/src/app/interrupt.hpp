// Ctrl-C, SIGTERM and SIGHUP end a run in good order; a second one ends the process at once.
#pragma once

#include <atomic>

namespace grit {

/// Until catch_interrupts() these signals end the process with exit status 130: nothing was written that would have to
/// be saved. Returns the flag of catch_interrupts().
const std::atomic<bool>& end_on_interrupts();

/// From now on they set a flag, which is returned. SIGHUP stays ignored if it is, as by nohup, and a second SIGHUP is
/// ignored, as a terminal that closes may send several.
const std::atomic<bool>& catch_interrupts();

}  // namespace grit
