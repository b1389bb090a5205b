// What `grit run` is to do: descriptions, and where their results go.
#pragma once

#include <filesystem>
#include <memory>
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
};

/// One for each word of the command line: a description's file, or with --resume the folder of a run, which has its
/// description. Throws UsageError; FileError for a folder that is in use, or holds results that are to stay.
std::vector<RunJob> jobs_of(const Options& options);

/// Opens all of them before the first is run, so that a slip in the last shows at once. Throws DescriptionError with
/// the problems of all; FileError; PluginError.
void open_all(std::vector<RunJob>& jobs, const Options& options);

}  // namespace grit
