// What the process says when it ends.
#pragma once

namespace grit {

enum class ExitStatus {
  done = 0,
  usage = 1,
  description = 2,
  plugin = 3,
  numerics = 4,  ///< a guard tripped, a stage did not end, an expectation was not met
  files = 5,
  defect = 70,  ///< an error that grit does not foresee: a defect of grit or of a plugin
  interrupted = 130,
};

}  // namespace grit
