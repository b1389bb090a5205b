// The folder of several runs of one command: what it holds, and who writes there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "output/folder_lock.hpp"
#include "output/run_json.hpp"

namespace grit {

/// results/NAME of a file NAME.json. Throws UsageError if no folder has this name.
std::filesystem::path default_results(const std::filesystem::path& file);

/// The state of a run on disk.
enum class Progressed {
  nothing,  ///< no run, or one that began and cannot be resumed
  other,    ///< a run of another description, another grit or another build of a plugin
  begun,    ///< interrupted or killed; can be resumed
  lost,     ///< done, but its series is missing or unreadable
  ended,    ///< done or failed numerically
};

/// The state of the run of this description with these plugins in a folder.
Progressed progressed(const std::filesystem::path& folder, const Description& description,
                      const std::vector<PluginUsed>& plugins);

/// Throws FileError: the first of so many runs of another description is in `folder`, and runs in `out` would replace
/// them.
[[noreturn]] void refuse_other_runs(const std::filesystem::path& out, std::size_t count,
                                    const std::filesystem::path& folder);

/// Whether the series of a run can be read.
bool has_series(const std::filesystem::path& folder);

/// The message for a run that is done and has none.
std::string lost_series(const std::filesystem::path& folder);

/// The contents of a text file; empty if it cannot be read.
std::string text_of(const std::filesystem::path& path);

/// The message for a run whose program failed: its exit status, or minus the signal that killed it, and its log.
std::string failed_run_text(const std::string& run, int status, const std::filesystem::path& log);

/// Throws FileError if another process holds the lock. `command`: "grit study".
void lock_folder(const std::filesystem::path& out, const std::string& command, std::optional<FolderLock>& lock);

/// A file as JSON; a discarded value if it cannot be read.
Description json_at(const std::filesystem::path& path);

/// Whether a file is the study.json of a study, or the calibration.json of a calibration.
bool is_study_json(const std::filesystem::path& path);
bool is_calibration_json(const std::filesystem::path& path);

enum class ResultsOf { run, study, calibration };

/// Throws FileError if a folder holds the results of another command, with which those of this one would be mixed.
void refuse_results_of_others(const std::filesystem::path& folder, ResultsOf own);

/// Throws FileError if a folder holds a run that neither a study nor a calibration began, or is a symbolic link: it
/// would be lost.
void refuse_foreign_run(const std::filesystem::path& folder);

}  // namespace grit
