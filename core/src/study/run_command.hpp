// The command lines of a study's runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grit {

/// What all runs of a study have in common.
struct RunProgram {
  std::filesystem::path program;            ///< of grit
  unsigned threads = 1;                     ///< per run
  std::vector<std::string> plugin_paths{};  ///< folders with more plugins
};

/// `grit run` for one sample of a variant: it continues from a checkpoint, or replaces what the folder holds.
std::vector<std::string> run_words(const RunProgram& with, const std::string& scene,
                                   const std::filesystem::path& folder, const std::vector<std::string>& sets,
                                   bool resume);

/// Whether a command line is one of run_words().
bool is_of_study(const std::vector<std::string>& words);

/// `grit study --only`, to which the name of a run is added. It looks at what the folder of the run holds when it is
/// started, and so may be started again at any time: by a scheduler, or by hand. `overwrite`: it replaces a run of
/// another description.
std::vector<std::string> task_words(const RunProgram& with, const std::filesystem::path& study,
                                    const std::filesystem::path& out, bool overwrite);

}  // namespace grit
