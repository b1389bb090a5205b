// Does the runs of a study by a scheduler: as a job array of Slurm, or by GNU parallel.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "app/study_runs.hpp"
#include "study/submission.hpp"

namespace grit {

void add_submit_options(Options& options);
/// Throws UsageError for options that do not go together; FileError without the program of the scheduler.
void check_submit_options(const Options& options);

/// Throws FileError if a job array of the study is in the queue of Slurm: its tasks write to the same folders.
void refuse_queued_job(const std::filesystem::path& out);

/// Writes the script of a job array and submits it, or only writes it with --dry-run. `estimated`: of the largest run.
/// Throws FileError.
void submit_to_slurm(const StudyPlace& place, const std::vector<StudyRun>& runs, const Options& options,
                     const TaskLimits& estimated);

/// Writes the script of GNU parallel and runs it, or only writes it with --dry-run. `waiting` gets the number of runs
/// that have ended. Throws FileError.
void run_in_parallel(const StudyPlace& place, const std::vector<StudyRun>& runs, const Options& options,
                     const std::atomic<bool>& interrupted, const std::function<void(std::size_t)>& waiting);

/// The command that evaluates the runs of a study.
std::string collect_command(const StudyPlace& place, const Options& options);

}  // namespace grit
