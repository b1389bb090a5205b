// The commands, one file per command. Help, manual pages and completion are made of these declarations.
#pragma once

#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "app/exit_status.hpp"

namespace grit {

class Options;

/// An invalid command line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Names of values, in synopses and options, say what completes them: app/completion.hpp.
struct Command {
  const char* name;
  const char* synopsis;                ///< what the command takes, e.g. "FILE…"
  const char* doc;                     ///< one line
  const char* text;                    ///< a paragraph; the name of another command is in single quotes
  void (*options)(Options&);           ///< declares its options
  ExitStatus (*main)(const Options&);  ///< throws UsageError and grit::Error
};

void run_options(Options& options);
void check_options(Options& options);
void expand_options(Options& options);
void study_options(Options& options);
void calibrate_options(Options& options);
void advise_options(Options& options);
void report_options(Options& options);
void new_options(Options& options);
void manual_options(Options& options);

ExitStatus run_command(const Options& options);
ExitStatus check_command(const Options& options);
ExitStatus expand_command(const Options& options);
ExitStatus schema_command(const Options& options);
ExitStatus plugins_command(const Options& options);
ExitStatus describe_command(const Options& options);
ExitStatus study_command(const Options& options);
ExitStatus calibrate_command(const Options& options);
ExitStatus advise_command(const Options& options);
ExitStatus report_command(const Options& options);
ExitStatus new_command(const Options& options);
ExitStatus manual_command(const Options& options);

std::span<const Command> commands();
/// Throws UsageError.
const Command& command(const std::string& name);

/// A variable of the environment, or a file, with what it does.
struct Named {
  const char* name;
  const char* doc;
};
std::span<const Named> environment();
std::span<const Named> result_files();

inline constexpr const char* about_grit = "discrete element method for sand, shear zones and silos";

/// Runs `work`; prints its exceptions to standard error and maps them to an exit status.
ExitStatus report(const std::function<ExitStatus()>& work);

}  // namespace grit
