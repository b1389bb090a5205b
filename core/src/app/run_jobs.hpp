// The runs of `grit run`: descriptions, and the folders of their results.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "output/results_folder.hpp"
#include "simulation/opened_scene.hpp"

namespace grit {

struct RunJob {
  std::string file;              ///< of the description
  std::filesystem::path folder;  ///< of the results
  Existing existing = Existing::refuse;
  std::shared_ptr<OpenedScene> opened = nullptr;
  DescriptionSource source = {};
};

/// One for each word of the command line: the file of a description or, with --resume, the folder of a run, which holds
/// its description. Throws UsageError; FileError for a folder that is in use, holds results, or holds other files under
/// their names.
std::vector<RunJob> jobs_of(const Options& options);

/// The only one, without its folder, for a rank that writes nothing. Throws UsageError, FileError.
RunJob named_job(const Options& options);
/// Opens it. Throws DescriptionError, FileError, PluginError.
void open(RunJob& job, const Options& options);

/// Opens all of them before the first is run, so that a fault in the last is reported at once. Throws DescriptionError
/// with the problems of all; FileError, also for a run that would replace a file that it reads; PluginError.
void open_all(std::vector<RunJob>& jobs, const Options& options);

/// The files and folders that a run reads: its description, those that this extends, and those that it names.
std::set<std::filesystem::path> inputs_of(const RunJob& job);

}  // namespace grit
