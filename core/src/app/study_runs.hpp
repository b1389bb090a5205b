// The runs of a study: which are missing, and what their folders hold.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/estimate.hpp"
#include "app/options.hpp"
#include "study/description.hpp"
#include "study/run_command.hpp"
#include "study/variants.hpp"

namespace grit {

/// A study and where its runs are.
struct StudyPlace {
  StudyDescription study;
  std::filesystem::path file;  ///< of the study
  std::filesystem::path out;   ///< folder of the runs
};

/// A run that is to be done.
struct StudyRun {
  std::string name;                ///< "friction=20 deg, seed 1"
  std::filesystem::path within;    ///< its folder, relative to that of the study
  std::filesystem::path folder;    ///< the same below StudyPlace::out
  std::vector<std::string> words;  ///< the command line of `grit run`
  bool replaces = false;           ///< another run in its folder
};

/// The missing runs; `all` counts all runs. Metrics and channels are checked. Calls `each_variant` with the scene of
/// each variant that misses a run. Throws DescriptionError if a run or a metric is invalid.
std::vector<StudyRun> missing_runs(const StudyPlace& place, const Options& options, const Registry& registry,
                                   std::size_t& all,
                                   const std::function<void(const LiveScene&, const Scene&)>& each_variant = {});

/// Warns of values that the study sets, and that have no effect in any of its variants.
void warn_of_idle_settings(const StudyPlace& place, const Registry& registry);

/// Existing runs that are of another description, or have lost their series: by folder, why.
std::map<std::filesystem::path, std::string> unusable_runs(const StudyPlace& place, const Options& options,
                                                           const Registry& registry);

/// Does one run, of any variant and seed: replaces this process by `grit run`, which continues from a checkpoint if
/// there is one. Returns if the run has ended before. `within`: as in StudyRun.
ExitStatus do_only(const StudyPlace& place, const std::string& within, const Options& options,
                   const Registry& registry);

/// What this program has in common with the runs that it starts.
RunProgram run_program(const Options& options);

}  // namespace grit
