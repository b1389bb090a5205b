// Exit statuses of the program.
#pragma once

namespace grit {

enum class ExitStatus {
  done = 0,
  usage = 1,
  description = 2,
  plugin = 3,
  numerics = 4,  ///< a guard tripped, a stage did not end, or an expectation was not met
  files = 5,
  defect = 70,  ///< an unexpected error: a defect of grit or of a plugin
  interrupted = 130,
};

}  // namespace grit
