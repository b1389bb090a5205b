// Libraries and plugins that call exit() end the process as if its work were done. The C++ library calls abort() where
// memory ends too early for an exception.
#pragma once

#include "app/exit_status.hpp"

namespace grit {

/// From now on exit() ends the process with the status of a defect, and a message that names the file of its caller;
/// want of memory for an exception ends it with the status of files. Call it once.
void refuse_early_exit();
/// The work is done: exit() ends the process as usual. Returns the status.
int finish(ExitStatus status);

}  // namespace grit
