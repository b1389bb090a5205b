// The commands, one file per command.
#pragma once

#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/exit_status.hpp"

namespace grit {

/// An invalid command line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Takes the words after the command's name. Throws UsageError and grit::Error.
using CommandMain = ExitStatus (*)(const std::vector<std::string>& words);

struct Command {
  const char* name;
  const char* synopsis;
  const char* doc;
  CommandMain main;
};

ExitStatus run_command(const std::vector<std::string>& words);
ExitStatus check_command(const std::vector<std::string>& words);
ExitStatus expand_command(const std::vector<std::string>& words);
ExitStatus schema_command(const std::vector<std::string>& words);
ExitStatus plugins_command(const std::vector<std::string>& words);
ExitStatus describe_command(const std::vector<std::string>& words);
ExitStatus study_command(const std::vector<std::string>& words);
ExitStatus calibrate_command(const std::vector<std::string>& words);
ExitStatus advise_command(const std::vector<std::string>& words);
ExitStatus report_command(const std::vector<std::string>& words);

std::span<const Command> commands();

/// Runs `work`; prints its exceptions to standard error and maps them to an exit status.
ExitStatus report(const std::function<ExitStatus()>& work);

}  // namespace grit
