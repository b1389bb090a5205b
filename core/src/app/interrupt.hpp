// What the system does to a run. Ctrl-C, SIGTERM, SIGHUP and SIGXCPU, for used computing time, end it in good order; a
// second Ctrl-C or SIGTERM ends the process at once. Output that cannot be written does not end the process.
#pragma once

#include <atomic>

namespace grit {

/// For every command, before it opens a file: none takes the place of a closed standard output, into which messages
/// would be written, and a file beyond the allowed size (ulimit -f) is an error of its writer.
void prepare_outputs();

/// From now on the process goes on when the reader of a pipe ends, such as `head`, or `tee` by the same Ctrl-C.
void outlive_readers();

/// Whether an output is a pipe or terminal whose other end is closed.
bool has_no_reader(int file);

/// Until catch_interrupts() these signals end the process with exit status 130: nothing was written that would have to
/// be saved. Returns the flag of catch_interrupts().
const std::atomic<bool>& end_on_interrupts();

/// From now on they set a flag, which is returned. SIGHUP stays ignored if it is, as by nohup, and so are further
/// SIGHUP and SIGXCPU.
const std::atomic<bool>& catch_interrupts();

}  // namespace grit
