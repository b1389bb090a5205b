// Exit statuses of the program.
#pragma once

#include <array>

namespace grit {

enum class ExitStatus {
  done = 0,
  usage = 1,
  description = 2,
  plugin = 3,
  numerics = 4,
  files = 5,
  defect = 70,
  interrupted = 130,
};

struct ExitStatusText {
  ExitStatus status;
  const char* name;  ///< in help
  const char* doc;   ///< in manual pages
};

inline constexpr std::array<ExitStatusText, 8> exit_statuses{{
    {ExitStatus::done, "done", "Done."},
    {ExitStatus::usage, "usage", "The command line is wrong."},
    {ExitStatus::description, "description", "The description cannot be run, or a file that it names cannot be read."},
    {ExitStatus::plugin, "plugin",
     "A plugin is missing, cannot be loaded or violates its interface, e.g. by an exception."},
    {ExitStatus::numerics, "numerics", "A guard stopped the run, a stage did not end, or an expectation was not met."},
    {ExitStatus::files, "files or disk", "A file cannot be read or written, or the memory or the disk is full."},
    {ExitStatus::defect, "defect of the program", "A defect of grit or of a plugin."},
    {ExitStatus::interrupted, "interrupted and saved",
     "Interrupted by Ctrl-C, a termination signal, a closed terminal or used computing time, and saved."},
}};

}  // namespace grit
