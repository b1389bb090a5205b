// Scripts that do the runs of a study beyond this process: a job array of Slurm, a batch of GNU parallel.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace grit {

/// The runs of a study that are to be done elsewhere.
struct Submission {
  std::string name;                  ///< of the study
  std::filesystem::path directory;   ///< working directory of the runs, absolute
  std::filesystem::path folder;      ///< receives scripts and logs, absolute
  std::vector<std::string> command;  ///< does the run whose name follows, see task_words()
  std::vector<std::string> runs;     ///< their names, such as "runs/usual/seed-1"
  unsigned threads = 1;              ///< per run
};

/// What a task may take, from an estimate of the largest run.
struct TaskLimits {
  double seconds = 0, bytes = 0;
};

/// The time limit [s]: three times the estimate, at least 10 minutes, at most a day. A run that takes longer continues
/// from its checkpoint.
double time_limit(double estimated);
/// The memory to request [bytes]: twice the estimate, and room for the program.
double memory_limit(double estimated);

struct SlurmOptions {
  TaskLimits limits;                  ///< as requested
  std::optional<unsigned> at_once{};  ///< largest number of running tasks
  std::vector<std::string> sbatch{};  ///< options for sbatch, which replace those of the script
};

/// A script for sbatch: one task per run. Throws Error if a path cannot be written in one.
std::string slurm_script(const Submission& of, const SlurmOptions& options);

struct ParallelOptions {
  std::optional<unsigned> at_once{};  ///< running at once on each host; default: as many as it has cores for
  std::string hosts{};                ///< a file with one host a line, or a list with commas; empty: this machine
};

/// A script that runs GNU parallel. Throws Error as slurm_script() does.
std::string parallel_script(const Submission& of, const ParallelOptions& options);

/// Whether a script is one of these.
bool is_own_script(const std::filesystem::path& path);

/// The number of a job in the output of `sbatch --parsable`; empty if it has none.
std::string job_in(const std::string& output);

/// The file of an executable in PATH; empty if there is none.
std::filesystem::path program_in_path(const std::string& name);

}  // namespace grit
